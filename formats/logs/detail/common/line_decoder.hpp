/// Decoders of logs in lines: cuts pieces of any length into whole lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Longer lines are no text of a log: they are counted as corrupt and passed over, so that memory stays
/// bounded.
inline constexpr std::size_t kLongestLine = 1U << 20U;

/// Base of decoders that work line by line.
class LineDecoder : public LogDecoder {
 public:
  /// @param path  the log's name, for messages
  LineDecoder(std::string path, LogRequest request) : path_(std::move(path)), request_(std::move(request)) {}
  void take(std::string_view piece) final;
  void finish() final;

 protected:
  /// @param line    without its end ("\n" or "\r\n"); may be empty; valid during the call only
  /// @param number  1-based
  virtual void take_line(std::string_view line, std::size_t number) = 0;
  /// After the last line.
  virtual void end() {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const LogRequest& request() const { return request_; }
  /// Counts a corrupt record in this log.
  void corrupt(std::size_t line, std::size_t column, const std::string& what) {
    add_corrupt(data_, path_, line, column, what);
  }
  /// Adds a note that begins with the log's name.
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

/// The lines that a log begins with, for LogReader::recognise: without blank ones, and without a last one
/// that has no end and so may be cut off (unless it is the only one).
class HeadLines {
 public:
  explicit HeadLines(std::string_view head) : rest_(head) {}
  /// Goes to the next line. @return false behind the last
  [[nodiscard]] bool next();
  /// Without its end.
  [[nodiscard]] std::string_view line() const { return line_; }
  /// How many there were so far.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// "9 of 10 lines are ...", as sure as their share; nothing where there are none of them.
  /// @param what  follows the numbers: "are CAN frames"
  [[nodiscard]] Recognition share(std::size_t known, std::string_view what) const;

 private:
  std::string_view rest_;
  std::string_view line_;
  std::size_t count_ = 0;
};

}  // namespace waymark::formats
