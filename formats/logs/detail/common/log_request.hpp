/// Checks of a request: they refuse what a kind of log cannot give, with the same words in
/// all readers.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// @param format the kind of log in the message: "an RTKLIB solution"
/// @throws InputError if the stream is not among the given ones
void require_streams(const std::string& path, const LogRequest& request, std::string_view format,
                     std::initializer_list<StreamKind> given);
/// @throws InputError if the request has a column map
void require_no_columns(const std::string& path, const LogRequest& request, std::string_view format);
/// @param known the one companion file that this kind of log takes; empty: none
/// @throws InputError for any other companion
void require_companions(const std::string& path, const LogRequest& request, std::string_view format,
                        std::string_view known = {});
/// Allows the streams gnss and truth, no columns and no companions, as the logs of
/// receivers need it.
void require_positions(const std::string& path, const LogRequest& request, std::string_view format);

}  // namespace waymark::formats
