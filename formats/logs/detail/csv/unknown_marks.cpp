#include <waymark/formats/logs/detail/csv/unknown_marks.hpp>

#include <optional>

#include <waymark/formats/logs/detail/common/record_fields.hpp>

namespace waymark::formats {
namespace {

std::size_t take_out(const UnknownMarks& marks, std::size_t column, SensorTable& readings) {
  std::size_t count = 0;
  for (std::size_t i = column; i < readings.values.size(); i += readings.columns) {
    if (!marks.is_mark(readings.values[i])) continue;
    readings.values[i] = kNoNumber;
    ++count;
  }
  return count;
}

std::size_t take_out(const UnknownMarks& marks, std::optional<double> GeodeticFix::*value,
                     std::optional<double> GeodeticFix::*sigma, std::vector<GeodeticFix>& fixes) {
  std::size_t count = 0;
  for (GeodeticFix& fix : fixes) {
    if (!(fix.*value) || !marks.is_mark(*(fix.*value))) continue;
    (fix.*value).reset();
    (fix.*sigma).reset();
    ++count;
  }
  return count;
}

}  // namespace

std::size_t take_out_marks(const UnknownMarks& marks, const LogRequest& request, LogData& data) {
  const std::string_view name = marks.column().quantity->name;
  for (std::size_t i = 0; i < request.readings.size(); ++i)
    if (request.readings[i].name == name) return take_out(marks, i, data.readings);
  if (request.stream == StreamKind::odometry)
    return std::erase_if(data.odometry,
                         [&](const OdometrySample& sample) { return marks.is_mark(sample.speed_mps); });
  if (name == "course")
    return take_out(marks, &GeodeticFix::course_rad, &GeodeticFix::course_sigma_rad, data.fixes);
  return take_out(marks, &GeodeticFix::speed_mps, &GeodeticFix::speed_sigma_mps, data.fixes);
}

}  // namespace waymark::formats
