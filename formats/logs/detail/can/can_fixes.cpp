#include <waymark/formats/logs/detail/can/can_fixes.hpp>

#include <cmath>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/record_fields.hpp>

namespace waymark::formats {
namespace {

/// Returns the time between two stamps in any order, without overflow.
std::uint64_t distance(Stamp a, Stamp b) {
  const auto x = static_cast<std::uint64_t>(a.nanoseconds);
  const auto y = static_cast<std::uint64_t>(b.nanoseconds);
  return a > b ? x - y : y - x;
}

bool one_burst(Stamp a, Stamp b) {
  return distance(a, b) <= static_cast<std::uint64_t>(kBurstNanoseconds);
}

}  // namespace

FixAssembler::FixAssembler(const std::vector<Quantity>& quantities, const std::vector<BoundSignal>& bound,
                           const LogRequest& request, const std::string& path, LogData& data)
    : quantities_(quantities),
      bound_(bound),
      path_(path),
      data_(data),
      positions_(path, request, nullptr),
      latitude_(place_of("latitude")),
      longitude_(place_of("longitude")),
      height_(place_of("height")),
      heading_(place_of("heading")),
      course_(place_of("course")),
      course_accuracy_(place_of("course_accuracy")),
      speed_(place_of("speed")),
      speed_accuracy_(place_of("speed_accuracy")),
      valid_(place_of("valid")),
      quality_(place_of("quality")),
      hdop_(place_of("hdop")),
      satellites_(place_of("satellites")),
      correction_age_(place_of("correction_age")),
      newest_(quantities.size()),
      nearest_(quantities.size()) {
  if (request.stream != StreamKind::gnss) return;
  const auto wanted = request.columns.find("quality");
  if (wanted != request.columns.end()) quality_code_ = wanted->second.unit;
  const auto has = [&](std::string_view name) { return place_of(name) != kNowhere; };
  accuracy_ = choose_accuracy(has, path, request, data.notes);
  east_ = place_of(accuracy_.east);
  north_ = place_of(accuracy_.north);
  covariance_root_ = place_of(accuracy_.covariance_root);
}

std::size_t FixAssembler::place_of(std::string_view name) const {
  for (const BoundSignal& bound : bound_) {
    if (quantities_[bound.quantity].name == name) return bound.quantity;
  }
  return kNowhere;
}

void FixAssembler::take(Stamp stamp, std::size_t line, std::span<const SignalValue> values) {
  bool position = false;
  for (const SignalValue& signal : values)
    position = position || signal.quantity == latitude_ || signal.quantity == longitude_;
  if (open_ && (position || !one_burst(stamp, position_.stamp))) close();

  for (const SignalValue& signal : values) {
    const Given given{signal.value, stamp, line, true};
    if (signal.quantity == latitude_) {
      take_part(latitude_part_, given, "latitude", "longitude");
    } else if (signal.quantity == longitude_) {
      take_part(longitude_part_, given, "longitude", "latitude");
    } else {
      newest_[signal.quantity] = given;
      Given& nearest = nearest_[signal.quantity];
      if (open_ &&
          (!nearest.there || distance(stamp, position_.stamp) < distance(nearest.stamp, position_.stamp)))
        nearest = given;
    }
  }
  if (latitude_part_.there && longitude_part_.there) open();
}

void FixAssembler::take_part(Given& part, const Given& given, std::string_view name, std::string_view other) {
  if (part.there) complain(part.line, fmt::format("{} without a {} within 0.1 s", name, other));
  part = given;
}

void FixAssembler::complain(std::size_t line, const std::string& what) {
  ++data_.records;
  add_corrupt(data_, path_, line, 1, what);
}

/// Opens a fix from the two parts, unless they belong to different bursts.
void FixAssembler::open() {
  const bool latitude_later = latitude_part_.line >= longitude_part_.line;
  const Given& later = latitude_later ? latitude_part_ : longitude_part_;
  if (!one_burst(latitude_part_.stamp, longitude_part_.stamp)) {
    const Given alone = latitude_later ? longitude_part_ : latitude_part_;
    (latitude_later ? longitude_part_ : latitude_part_).there = false;
    return complain(alone.line, latitude_later ? "longitude without a latitude within 0.1 s"
                                               : "latitude without a longitude within 0.1 s");
  }
  open_ = true;
  position_ = later;
  position_deg_[0] = latitude_part_.value;
  position_deg_[1] = longitude_part_.value;
  latitude_part_.there = longitude_part_.there = false;
  for (std::size_t i = 0; i < newest_.size(); ++i) {
    nearest_[i] = newest_[i];
    nearest_[i].there = newest_[i].there && one_burst(newest_[i].stamp, position_.stamp);
  }
}

void FixAssembler::close() {
  open_ = false;
  if (valid_ != kNowhere) {
    if (!nearest_[valid_].there)
      return complain(position_.line, "no frame within 0.1 s tells whether the fix is valid");
    if (!(value(valid_) != 0)) {
      ++data_.records;
      ++data_.without_fix;
      return;
    }
  }
  for (const auto& [place, number] :
       {std::pair{latitude_, position_deg_[0]}, {longitude_, position_deg_[1]}}) {
    if (!std::isnan(number)) continue;
    const Quantity& quantity = quantities_[place];
    return complain(position_.line, fmt::format("{}: the signal is outside {:.6g} .. {:.6g} deg",
                                                quantity.name, quantity.smallest, quantity.largest));
  }
  add_position();
}

/// Reads what the signals tell of a fix besides its accuracy. @return false: there is no fix
bool FixAssembler::read_details(GeodeticFix& fix) {
  if (const double code = value(quality_); !std::isnan(code)) {
    const TableQuality told = table_quality(fmt::format("{}", code), quality_code_).value_or(TableQuality{});
    if (told.no_fix) {
      ++data_.records;
      ++data_.without_fix;
      return false;
    }
    fix.told.quality = told.quality;
  }
  if (const double hdop = value(hdop_); hdop > 0) fix.told.hdop = hdop;
  if (const double count = value(satellites_); count >= 0 && count < 1000)
    fix.told.satellites = static_cast<int>(count);
  fix.told.correction_age_s = value(correction_age_);
  return true;
}

void FixAssembler::add_position() {
  GeodeticFix fix;
  if (!read_details(fix)) return;
  const StatedAccuracy accuracy =
      table_accuracy(value(east_), value(north_), value(covariance_root_), accuracy_);
  if (const char* what = positions_.set_covariance(fix, accuracy)) return complain(position_.line, what);
  ++data_.records;
  fix.stamp = position_.stamp;
  fix.latitude_deg = position_deg_[0];
  fix.longitude_deg = position_deg_[1];
  fix.height_m = value(height_);
  fix.course_rad = optional_value(course_);
  fix.course_sigma_rad = optional_sigma(course_accuracy_);
  fix.speed_mps = optional_value(speed_);
  fix.speed_sigma_mps = optional_sigma(speed_accuracy_);
  fix.line = position_.line;
  positions_.give(data_, fix, optional_value(heading_));
}

double FixAssembler::value(std::size_t place) const {
  return place == kNowhere || !nearest_[place].there ? kNoNumber : nearest_[place].value;
}

std::optional<double> FixAssembler::optional_value(std::size_t place) const {
  const double number = value(place);
  return std::isnan(number) ? std::nullopt : std::optional(number);
}

std::optional<double> FixAssembler::optional_sigma(std::size_t place) const {
  const double number = value(place);
  return number > 0 ? std::optional(number) : std::nullopt;
}

void FixAssembler::finish() {
  if (open_) close();
  if (latitude_part_.there) complain(latitude_part_.line, "latitude without a longitude within 0.1 s");
  if (longitude_part_.there) complain(longitude_part_.line, "longitude without a latitude within 0.1 s");
  latitude_part_.there = longitude_part_.there = false;
  positions_.finish(data_);
}

}  // namespace waymark::formats
