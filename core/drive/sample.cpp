#include <waymark/core/drive/sample.hpp>

namespace waymark {

std::string_view to_string(FixStatus status) {
  switch (status) {
    case FixStatus::accepted:
      return "accepted";
    case FixStatus::rejected:
      return "rejected";
    case FixStatus::withheld:
      return "withheld";
  }
  return "accepted";
}

std::optional<FixStatus> fix_status_from_string(std::string_view word) {
  for (const FixStatus status : {FixStatus::accepted, FixStatus::rejected, FixStatus::withheld}) {
    if (word == to_string(status)) return status;
  }
  return std::nullopt;
}

}  // namespace waymark
