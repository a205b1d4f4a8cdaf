#include <waymark/formats/log_data.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/core/error.hpp>

namespace waymark {

void add_corrupt(LogData& data, const std::string& path, std::size_t line, std::size_t column,
                 const std::string& what) {
  ++data.corrupt;
  if (data.corrupt_examples.size() < kCorruptExamples)
    data.corrupt_examples.push_back(fmt::format("{}:{}:{}: {}", path, line, column, what));
}

void require_samples(const LogData& data, const std::string& path, std::size_t without_fix) {
  if (data.odometry.size() + data.fixes.size() + data.truth.size() + data.readings.size() > 0) return;
  if (data.records == 0) throw InputError(fmt::format("{}: the log holds no records", path));
  if (data.corrupt > 0)
    throw InputError(fmt::format("{}: none of {} records could be used; first: {}", path, data.records,
                                 data.corrupt_examples.front()));
  throw InputError(fmt::format("{}: not one fix in {} records ({} are marked as without a fix)", path,
                               data.records, without_fix));
}

double sigma_factor(AccuracyMeaning meaning) {
  switch (meaning) {
    case AccuracyMeaning::automatic:
    case AccuracyMeaning::one_sigma:
      return 1;
    case AccuracyMeaning::percent95:
      return 0.5;
    case AccuracyMeaning::drms:
      return 1 / std::numbers::sqrt2;
    case AccuracyMeaning::cep50:
      return 1 / std::sqrt(2 * std::numbers::ln2);  // median of a Rayleigh distribution: sigma sqrt(2 ln 2)
  }
  return 1;
}

std::string_view to_string(AccuracyMeaning meaning) {
  switch (meaning) {
    case AccuracyMeaning::automatic:
      return "auto";
    case AccuracyMeaning::percent95:
      return "95";
    case AccuracyMeaning::one_sigma:
      return "1sigma";
    case AccuracyMeaning::drms:
      return "drms";
    case AccuracyMeaning::cep50:
      return "cep50";
  }
  return "auto";
}

}  // namespace waymark
