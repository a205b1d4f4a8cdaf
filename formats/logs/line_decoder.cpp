#include <waymark/formats/logs/line_decoder.hpp>

namespace waymark {

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

/// Holds back a part of a line; of a line that has grown too long nothing.
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
    corrupt(number_, 1, "a line of more than 1 MiB, which no record of a log is");
    return;
  }
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  take_line(line, number_);
}

}  // namespace waymark
