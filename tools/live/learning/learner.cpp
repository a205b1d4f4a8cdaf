#include <waymark/tools/live/learning/learner.hpp>

#include <algorithm>
#include <utility>

namespace waymark::live {
namespace {

constexpr double kGrowth = 1.5;             // of the drive, until the next search
constexpr double kRarest_s = 600;           // between two searches
constexpr double kLeastShare = 0.5;         // of the drive of the last search, to be worth another one
constexpr double kAllowed_s = 10;           // for a search, at least
constexpr double kAllowedShare = 1.0 / 15;  // of the drive, for a search in it

/// Ends a search whose result nobody wants.
struct Stopped {};

}  // namespace

bool Learner::is_due(Stamp now, double length_s) const {
  if (future_.valid()) return false;
  const bool tells_as_much = length_s >= kLeastShare * last_length_s_;
  return length_s >= next_s_ || (last_ && tells_as_much && seconds_between(*last_, now) >= kRarest_s);
}

void Learner::begin(Stamp now, double length_s, Work work) {
  last_ = now;
  last_length_s_ = length_s;
  ready_ = now.later(std::max(kAllowed_s, kAllowedShare * length_s));
  next_s_ = std::max(next_s_, length_s) * kGrowth;
  stop_ = std::make_shared<std::atomic<bool>>(false);
  future_ = beside_([work = std::move(work), stop = stop_, outside = stop_from_outside_] {
    return work([&stop = *stop, outside] {
      if (stop || (outside != nullptr && *outside)) throw Stopped();
    });
  });
}

std::optional<Learned> Learner::result(Stamp now) {
  if (!future_.valid() || now < ready_) return std::nullopt;
  try {
    return future_.get();
  } catch (const Stopped&) {
    return std::nullopt;
  }
}

void Learner::forget() {
  if (stop_) *stop_ = true;
  future_ = {};
  last_.reset();
  last_length_s_ = 0;
  next_s_ = std::min(next_s_, kRarest_s);
}

}  // namespace waymark::live
