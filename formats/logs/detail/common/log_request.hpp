/// What a reader refuses of a request because its kind of log cannot give it, in the same words for all.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// `format` names the kind of log in the complaint: "an RTKLIB solution".
/// @throws InputError for a stream that is not among the given ones
void require_streams(const std::string& path, const LogRequest& request, std::string_view format,
                     std::initializer_list<StreamKind> given);
/// @throws InputError for a column map
void require_no_columns(const std::string& path, const LogRequest& request, std::string_view format);
/// @param known  the one companion file that this kind of log takes; empty: none
/// @throws InputError for any other
void require_companions(const std::string& path, const LogRequest& request, std::string_view format,
                        std::string_view known = {});
/// The streams gnss and truth, no columns, no companions: what logs of receivers are read with.
void require_positions(const std::string& path, const LogRequest& request, std::string_view format);

}  // namespace waymark::formats
