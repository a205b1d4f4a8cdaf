#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/core/error.hpp>
#include <waymark/formats/stamp_text.hpp>
#include <waymark/formats/trajectory.hpp>

namespace waymark {
namespace {

constexpr std::array<std::string_view, 8> kFields{"t", "x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::string_view kBlanks = " \t\r";

/// One line of the file, read token by token.
class TumLine {
 public:
  TumLine(std::string_view text, std::string_view name, std::size_t number)
      : text_(text), name_(name), number_(number) {}

  [[nodiscard]] bool is_data() {
    skip_blanks();
    return at_ < text_.size() && text_[at_] != '#';
  }

  [[nodiscard]] StampedPose pose() {
    const std::optional<Stamp> stamp = stamp_from_decimal_seconds(token(kFields[0]));
    if (!stamp) fail_number(kFields[0]);
    std::array<double, 8> value{};
    std::size_t quaternion = 0;
    for (std::size_t field = 1; field < value.size(); ++field) {
      value[field] = number(kFields[field]);
      if (field == 4) quaternion = last_;
    }
    check_end();
    return StampedPose{.stamp = *stamp,
                       .pose = {value[1], value[2], yaw(value[4], value[5], value[6], value[7], quaternion)}};
  }

 private:
  void check_end() {
    skip_blanks();
    if (at_ == text_.size()) return;
    const std::string_view extra = token("");
    fail(last_, fmt::format("expected end of line after 8 numbers, got '{}'", extra));
  }

  void skip_blanks() { at_ = std::min(text_.find_first_not_of(kBlanks, at_), text_.size()); }

  std::string_view token(std::string_view field) {
    skip_blanks();
    last_ = at_;
    if (at_ == text_.size())
      fail(at_,
           fmt::format("expected number for '{}', got end of line (8 numbers a line: t x y z qx qy qz qw)",
                       field));
    at_ = std::min(text_.find_first_of(kBlanks, at_), text_.size());
    return text_.substr(last_, at_ - last_);
  }

  double number(std::string_view field) {
    std::string_view word = token(field);
    if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) fail_number(field);
    return value;
  }

  /// Yaw of a unit quaternion, rotation order z-y-x.
  double yaw(double x, double y, double z, double w, std::size_t column) const {
    const double norm = std::hypot(std::hypot(x, y), std::hypot(z, w));
    if (!(std::abs(norm - 1) <= 0.01))
      fail(column, fmt::format("expected a unit quaternion, got norm {:.6g}", norm));
    const double angle = std::atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
    return angle > -std::numbers::pi ? angle : std::numbers::pi;
  }

  [[noreturn]] void fail_number(std::string_view field) const {
    fail(last_, fmt::format("expected number for '{}', got '{}'", field, text_.substr(last_, at_ - last_)));
  }

  [[noreturn]] void fail(std::size_t offset, std::string_view problem) const {
    throw InputError(fmt::format("{}:{}:{}: TUM: {}", name_, number_, offset + 1, problem));
  }

  std::string_view text_;
  std::string_view name_;
  std::size_t number_;
  std::size_t at_ = 0;    ///< where the next token is looked for
  std::size_t last_ = 0;  ///< where the last token began
};

}  // namespace

std::vector<StampedPose> read_tum(std::string_view text, std::string_view name) {
  std::vector<StampedPose> poses;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    TumLine line(text.substr(0, end), name, number);
    if (line.is_data()) poses.push_back(line.pose());
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (poses.empty()) throw InputError(fmt::format("{}: TUM: no pose in it", name));
  return poses;
}

}  // namespace waymark
