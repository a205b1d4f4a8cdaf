#include <waymark/formats/text/detail/read_failure.hpp>

#include <system_error>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>

namespace waymark::formats {

void fail_read(const std::string& path, int error) {
  throw InputError(fmt::format("{}: cannot read: {}", path, std::generic_category().message(error)));
}

}  // namespace waymark::formats
