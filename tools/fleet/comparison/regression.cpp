#include <waymark/tools/fleet/comparison/regression.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>

namespace waymark::fleet {
namespace {

using evaluation::kUndefined;

using Key = std::pair<std::string, std::string>;  ///< drive, modeling

struct Entry {
  const DriveRecord* record = nullptr;
  const ModelingRow* row = nullptr;  ///< null: the drive failed
};

/// A failed drive has no modeling; it pairs with every one that the other fleet has of it.
std::map<Key, Entry> entries_of(const Fleet& fleet) {
  std::map<Key, Entry> entries;
  for (const DriveRecord& record : fleet.records) {
    if (record.rows.empty()) entries[{record.drive, ""}] = {&record, nullptr};
    for (const ModelingRow& row : record.rows) entries[{record.drive, row.modeling}] = {&record, &row};
  }
  return entries;
}

const Entry* find_entry(const std::map<Key, Entry>& entries, const Key& key) {
  auto found = entries.find(key);
  if (found == entries.end()) found = entries.find({key.first, ""});
  return found == entries.end() ? nullptr : &found->second;
}

Change judge(const PairedDrive& pair, const RegressionRule& rule) {
  const double difference = pair.new_error_m - pair.old_error_m;
  const bool matters =
      std::abs(difference) > rule.length_m && std::abs(difference) > rule.percent / 100 * pair.old_error_m;
  if (!matters) return Change::same;
  return difference > 0 ? Change::worse : Change::better;
}

PairedDrive paired(const Key& key, const Entry& before, const Entry& now, const RegressionRule& rule) {
  PairedDrive pair{
      .drive = key.first, .modeling = key.second, .environment = now.record->environment, .measure = ""};
  if (pair.environment.empty()) pair.environment = before.record->environment;
  const bool was_done = before.record->state == DriveState::done;
  const bool is_done = now.record->state == DriveState::done;
  if (before.row != nullptr) pair.old_error_m = before.row->error_m();
  if (now.row != nullptr) pair.new_error_m = now.row->error_m();
  if (was_done != is_done) {
    pair.change = was_done ? Change::lost : Change::gained;
    pair.reason = was_done ? now.record->reason : before.record->reason;
    return pair;
  }
  if (before.row == nullptr || now.row == nullptr) return pair;
  pair.measure = now.row->error_measure();
  if (!pair.measure.empty() && pair.measure == before.row->error_measure()) pair.change = judge(pair, rule);
  return pair;
}

bool is_judged(const PairedDrive& pair) {
  return pair.change == Change::worse || pair.change == Change::better || pair.change == Change::same;
}

ChangeOfGroup change_of(std::span<const PairedDrive* const> pairs, const RegressionRule& rule) {
  ChangeOfGroup change;
  std::vector<double> ratios;
  for (const PairedDrive* pair : pairs) {
    if (pair->change == Change::worse || pair->change == Change::lost) ++change.worse;
    if (pair->change == Change::better || pair->change == Change::gained) ++change.better;
    if (pair->change == Change::same) ++change.same;
    if (pair->change == Change::unjudged) ++change.unjudged;
    if (!is_judged(*pair)) continue;
    if (pair->new_error_m > pair->old_error_m + rule.tie_m) ++change.grew;
    if (pair->new_error_m < pair->old_error_m - rule.tie_m) ++change.shrank;
    if (pair->old_error_m > 0) ratios.push_back(pair->ratio());
  }
  change.chance = sign_test(change.grew, change.grew + change.shrank);
  std::sort(ratios.begin(), ratios.end());
  if (!ratios.empty()) {
    const std::size_t half = ratios.size() / 2;
    change.median_ratio = ratios.size() % 2 == 1 ? ratios[half] : (ratios[half - 1] + ratios[half]) / 2;
  }
  std::tie(change.ratio_low, change.ratio_high) = median_interval(ratios);
  return change;
}

void summarise(Regression& regression) {
  std::vector<const PairedDrive*> all;
  std::map<std::string, std::vector<const PairedDrive*>> by_environment;
  for (const PairedDrive& pair : regression.pairs) {
    all.push_back(&pair);
    by_environment[pair.environment].push_back(&pair);
  }
  regression.all = change_of(all, regression.rule);
  if (by_environment.size() < 2) return;
  for (const auto& [name, pairs] : by_environment)
    regression.environments.emplace_back(name, change_of(pairs, regression.rule));
}

/// log of the probability of k heads of n fair coins
double log_probability(std::size_t k, std::size_t n) {
  const auto log_factorial = [](std::size_t of) { return std::lgamma(static_cast<double>(of) + 1); };
  return log_factorial(n) - log_factorial(k) - log_factorial(n - k) - static_cast<double>(n) * std::log(2.0);
}

/// The probability of at most k heads.
double at_most(std::size_t k, std::size_t n) {
  double sum = 0;
  for (std::size_t i = 0; i <= k; ++i) sum += std::exp(log_probability(i, n));
  return sum;
}

}  // namespace

std::string RegressionRule::in_words() const {
  return fmt::format(
      "A drive got worse if its error grew by more than {:g} % and by more than {:g} m, or if it failed or "
      "found no minimum where it did before. The error is the root mean square against truth; without truth, "
      "at fixes that a second fusion did not know. The fleet got worse if it lost more drives than it gained, "
      "or if more errors grew than shrank and chance alone would split them so unevenly with a probability "
      "below {:g} % (two-sided exact sign test; differences up to {:g} m are ties).",
      percent, length_m, 100 * level, tie_m);
}

std::string to_string(Change change) {
  switch (change) {
    case Change::worse:
      return "worse";
    case Change::better:
      return "better";
    case Change::same:
      return "same";
    case Change::lost:
      return "lost";
    case Change::gained:
      return "gained";
    case Change::unjudged:
      return "unjudged";
  }
  return {};
}

FleetChange Regression::fleet() const {
  const auto count = [this](Change change) {
    return std::count_if(pairs.begin(), pairs.end(),
                         [&](const PairedDrive& p) { return p.change == change; });
  };
  const auto lost = count(Change::lost);
  const auto gained = count(Change::gained);
  const bool is_chance = all.chance >= rule.level;
  if (lost > gained || (!is_chance && all.grew > all.shrank)) return FleetChange::worse;
  if (lost < gained || (!is_chance && all.grew < all.shrank)) return FleetChange::better;
  return FleetChange::none;
}

Regression compare_fleets(const Fleet& before, const Fleet& now, const RegressionRule& rule) {
  Regression regression{.rule = rule,
                        .old_label = before.plan.label,
                        .new_label = now.plan.label,
                        .pairs = {},
                        .only_old = {},
                        .only_new = {},
                        .all = {},
                        .environments = {}};
  const std::map<Key, Entry> old_entries = entries_of(before);
  const std::map<Key, Entry> new_entries = entries_of(now);
  const auto name_of = [](const Key& key) {
    return key.second.empty() ? key.first : key.first + " " + key.second;
  };
  for (const auto& [key, entry] : new_entries) {
    const Entry* old_entry = find_entry(old_entries, key);
    if (old_entry != nullptr) regression.pairs.push_back(paired(key, *old_entry, entry, rule));
    // a drive that failed now is paired below, with each modeling that it had
    if (old_entry == nullptr && !key.second.empty()) regression.only_new.push_back(name_of(key));
  }
  for (const auto& [key, entry] : old_entries) {
    if (new_entries.contains(key)) continue;
    const Entry* new_entry = find_entry(new_entries, key);
    if (new_entry != nullptr) regression.pairs.push_back(paired(key, entry, *new_entry, rule));
    if (new_entry == nullptr && !key.second.empty()) regression.only_old.push_back(name_of(key));
  }
  if (regression.pairs.empty())
    throw InputError("the fleets have no drive in common; drives are paired by name and modeling");
  std::sort(regression.pairs.begin(), regression.pairs.end(), [](const PairedDrive& a, const PairedDrive& b) {
    return std::tie(a.drive, a.modeling) < std::tie(b.drive, b.modeling);
  });
  summarise(regression);
  return regression;
}

double sign_test(std::size_t k, std::size_t n) {
  if (n == 0) return 1;
  return std::min(1.0, 2 * at_most(std::min(k, n - k), n));
}

std::pair<double, double> median_interval(std::span<const double> ascending) {
  // The interval from the (k + 1)-th smallest to the (k + 1)-th largest misses with 2 P(at most k heads).
  const std::size_t n = ascending.size();
  if (n == 0 || 2 * at_most(0, n) > 0.05) return {kUndefined, kUndefined};
  std::size_t k = 0;
  double below = at_most(0, n);
  while (2 * (below + std::exp(log_probability(k + 1, n))) <= 0.05)
    below += std::exp(log_probability(++k, n));
  return {ascending[k], ascending[n - 1 - k]};
}

}  // namespace waymark::fleet
