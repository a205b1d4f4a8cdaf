#include <waymark/core/drive/drive_context.hpp>

#include <vector>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>

namespace waymark {

Geodesy::~Geodesy() = default;

const DriveSource& DriveContext::source(std::string_view name) const {
  std::vector<std::string_view> names;
  for (const DriveSource& known : sources) {
    if (known.name == name) return known;
    names.push_back(known.name);
  }
  throw UsageError("the drive has no source '" + std::string(name) + "'" + suggestion(name, names));
}

const Geodesy& DriveContext::require_geodesy() const {
  if (geodesy == nullptr)
    throw UsageError(
        "the frame of this drive has no known place on the Earth: no fix and no epoch of a sensor "
        "gives one (raw GNSS needs five pseudoranges at once); state 'frame: {utm_zone: ..., origin: "
        "[...]}'");
  return *geodesy;
}

const DriveContext& DriveContext::none() {
  static const DriveContext kNone;
  return kNone;
}

}  // namespace waymark
