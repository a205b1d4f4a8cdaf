#include <waymark/tools/program/terminal/progress.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/text/text_look.hpp>

namespace waymark::program {

double ProgressMeter::steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

ProgressMeter::ProgressMeter(Clock clock) : clock_(std::move(clock)) {
  restart();
}

void ProgressMeter::restart() {
  begin_s_ = now_s_ = clock_();
  done_ = total_ = 0;
}

void ProgressMeter::update(double done, double total) {
  now_s_ = clock_();
  done_ = done;
  total_ = total;
}

std::optional<double> ProgressMeter::rate() const {
  const double elapsed_s = now_s_ - begin_s_;
  if (elapsed_s < kEarliest_s || !(done_ > 0)) return std::nullopt;
  return done_ / elapsed_s;
}

std::optional<double> ProgressMeter::remaining_s() const {
  const std::optional<double> per_second = rate();
  if (!per_second || !(total_ > 0)) return std::nullopt;
  return std::max(0.0, total_ - done_) / *per_second;
}

bool ProgressMeter::due() {
  if (shown_s_ && now_s_ - *shown_s_ < kBetweenLines_s) return false;
  shown_s_ = now_s_;
  return true;
}

std::string duration_text(double seconds) {
  const double rounded = std::ceil(seconds);
  if (!(rounded < 1e9)) return "a very long time";
  const auto whole = static_cast<std::int64_t>(std::max(0.0, rounded));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string remaining_text(const ProgressMeter& meter) {
  const std::optional<double> remaining_s = meter.remaining_s();
  return remaining_s ? fmt::format("  {} left", duration_text(*remaining_s)) : "";
}

std::string reading_line(const std::string& name, std::uint64_t done, std::uint64_t size,
                         const ProgressMeter& meter) {
  constexpr std::size_t kNameColumns = 32;  // the rest must be visible in 80 columns
  const bool large = std::max(done, size) >= 1'000'000;
  const double unit = large ? 1e6 : 1e3;
  const char* word = large ? "MB" : "kB";
  std::string line =
      fmt::format("reading {}  {:.0f}", text::fitted(name, kNameColumns), static_cast<double>(done) / unit);
  if (size > 0) {
    line += fmt::format(" of {:.0f} {}  {} %", static_cast<double>(size) / unit, word,
                        std::min<std::uint64_t>(100, 100 * done / size));
  } else {
    line += fmt::format(" {}", word);
  }
  if (const auto rate = meter.rate()) line += fmt::format("  {:.0f} {}/s", *rate / unit, word);
  return line + remaining_text(meter);
}

std::string iteration_progress(int iteration, double chi2, const ProgressMeter& meter) {
  std::string line = fmt::format("iteration {}  chi2 {:.8g}", iteration, chi2);
  if (const auto rate = meter.rate()) line += fmt::format("  {:.3g} iterations/s", *rate);
  return line;
}

}  // namespace waymark::program
