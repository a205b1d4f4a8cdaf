/// Full steps that may climb, on trial: the watchdog technique of Chamberlain, Powell, Lemarechal and Pedersen, "The
/// watchdog technique for forcing convergence in algorithms for constrained optimization" (1982).
#pragma once

#include <algorithm>
#include <limits>

namespace waymark::solvers {

/// In a curved valley (a long chain that turns about its end) short steps that may not climb follow the floor, and
/// crawl: each promises nearly as much as the one before. Full steps leave it and come back further down. As many of them
/// as short ones have crawled, 16 at most, must lead below the chi2 of before, or all are undone.
class FullStepTrial {
 public:
  void reset() { *this = {}; }

  /// Tells whether short steps have crawled for so long that a trial is due.
  [[nodiscard]] bool is_due() const { return crawled_ >= patience_; }
  /// Tells whether a trial has climbed, and goes on.
  [[nodiscard]] bool is_on() const { return steps_ > 0; }
  /// Returns how many steps it has taken.
  [[nodiscard]] int steps() const { return steps_; }
  /// Returns how many it may take.
  [[nodiscard]] int longest() const { return std::min(patience_, kLongestTrial); }

  /// Hears of a short step that was taken. @param promised decrease of chi2
  void took_short_step(double promised) {
    crawled_ = promised > kCrawl * last_promised_ ? crawled_ + 1 : 0;
    last_promised_ = promised;
  }
  /// Hears of a full step that was taken. The trial ends as soon as it has led below. @param gained decrease of chi2;
  /// negative: it climbed
  void took_full_step(double gained) {
    gained_ += gained;
    ++steps_;
    crawled_ = 0;
    if (gained_ > 0) end();
  }
  /// Ends a trial in vain. The next one is due after short steps have crawled for twice as long.
  void fail() {
    end();
    patience_ = std::min(2 * patience_, kLongestPatience);
  }
  /// Ends a trial that nothing is concluded from.
  void end() {
    steps_ = 0;
    gained_ = 0;
    crawled_ = 0;
  }

 private:
  static constexpr double kCrawl = 0.5;  // a crawling step promises this share of the one before it
  static constexpr int kPatience = 4;    // crawling steps in a row
  static constexpr int kLongestPatience = 64;
  static constexpr int kLongestTrial = 16;

  double last_promised_ = std::numeric_limits<double>::infinity();  // by the last short step
  int crawled_ = 0;  // short steps in a row that promised nearly as much as the one before
  int patience_ = kPatience;
  int steps_ = 0;      // full steps since the first one that climbed
  double gained_ = 0;  // decrease of chi2 by them
};

}  // namespace waymark::solvers
