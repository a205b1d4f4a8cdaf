#include <waymark/formats/logs/detail/common/line_decoder.hpp>

#include <fmt/format.h>

namespace waymark::formats {

void LineDecoder::take(std::string_view piece) {
  while (!piece.empty()) {
    const std::size_t end = piece.find('\n');
    if (end == std::string_view::npos) return keep(piece);
    if (begun_.empty() && !too_long_) {
      give(piece.substr(0, end));
    } else {
      keep(piece.substr(0, end));
      give(begun_);
      begun_.clear();
      too_long_ = false;
    }
    piece.remove_prefix(end + 1);
  }
}

void LineDecoder::finish() {
  if (!begun_.empty() || too_long_) give(begun_);
  begun_.clear();
  too_long_ = false;
  end();
}

/// Holds back a part of a line, or nothing if the line has become too long.
void LineDecoder::keep(std::string_view part) {
  if (!too_long_ && begun_.size() + part.size() <= kLongestLine) {
    begun_ += part;
    return;
  }
  too_long_ = true;
  begun_.clear();
}

void LineDecoder::give(std::string_view line) {
  ++number_;
  if (too_long_ || line.size() > kLongestLine) {
    ++data_.records;
    corrupt(number_, 1, "a line of more than 1 MiB is no record of a log");
    return;
  }
  if (number_ == 1) line = without_byte_order_mark(line);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  take_line(line, number_);
}

bool HeadLines::next() {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos && count_ > 0) return false;
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    if (line_.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    ++count_;
    return true;
  }
  return false;
}

Recognition HeadLines::share(std::size_t known, std::string_view what) const {
  if (known == 0) return {};
  return {static_cast<double>(known) / static_cast<double>(count_),
          fmt::format("{} of {} lines {}", known, count_, what)};
}

}  // namespace waymark::formats
