/// The base of decoders for logs in lines: it cuts pieces of any length into whole lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/text/detail/byte_order_mark.hpp>

namespace waymark::formats {

/// A longer line is not text. It is counted as corrupt and skipped, so that memory stays bounded.
inline constexpr std::size_t kLongestLine = 1U << 20U;

/// The base of decoders that work line by line.
class LineDecoder : public LogDecoder {
 public:
  /// @param path name of the log, for messages
  LineDecoder(std::string path, LogRequest request) : path_(std::move(path)), request_(std::move(request)) {}
  void take(std::string_view piece) final;
  void finish() final;

 protected:
  /// Takes one line.
  /// @param line without its end ("\n" or "\r\n"), and the first one without a byte order mark; may be
  /// empty; valid only during the call
  /// @param number 1-based
  virtual void take_line(std::string_view line, std::size_t number) = 0;
  /// Called after the last line.
  virtual void end() {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const LogRequest& request() const { return request_; }
  /// Counts a corrupt record of this log.
  void corrupt(std::size_t line, std::size_t column, const std::string& what) {
    add_corrupt(data_, path_, line, column, what);
  }
  /// Adds a note that begins with the name of the log.
  void note(const std::string& text) { data_.notes.push_back(path_ + ": " + text); }

 private:
  void give(std::string_view line);
  void keep(std::string_view part);

  std::string path_;
  LogRequest request_;
  std::string begun_;  ///< a line whose end has not come yet
  bool too_long_ = false;
  std::size_t number_ = 0;
};

/// The first lines of a log, for LogReader::recognise. Blank lines are left out. A last line
/// without an end may be cut off, so it is left out too, unless it is the only one.
class HeadLines {
 public:
  explicit HeadLines(std::string_view head) : rest_(without_byte_order_mark(head)) {}
  /// Goes to the next line. @return false after the last one
  [[nodiscard]] bool next();
  /// The line without its end.
  [[nodiscard]] std::string_view line() const { return line_; }
  /// Returns how many lines there were so far.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Returns "9 of 10 lines are ..." with the share as confidence, or nothing if `known` is 0.
  /// @param what text after the numbers: "are CAN frames"
  [[nodiscard]] Recognition share(std::size_t known, std::string_view what) const;

 private:
  std::string_view rest_;
  std::string_view line_;
  std::size_t count_ = 0;
};

}  // namespace waymark::formats
