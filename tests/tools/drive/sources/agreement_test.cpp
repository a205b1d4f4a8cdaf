// Sources that contradict the others: who is named, and what is left out.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <random>

#include <waymark/tools/drive/comparison/agreement.hpp>
#include <waymark/types_se2/se2.hpp>

namespace agreement_test {

using namespace waymark;
using namespace waymark::drive;

namespace {

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : random_(seed) {}
  double operator()(double sigma) { return sigma * unit_(random_); }
  Eigen::Vector2d vector(double sigma) {
    const double x = (*this)(sigma);
    return {x, (*this)(sigma)};
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> unit_{0, 1};
};

/// Fixes of several receivers, once in a second, around a circle. Each has its own antenna.
struct Fixes {
  std::vector<Fix> fixes;
  std::vector<Eigen::Vector3d> poses;
  std::vector<std::size_t> voices;

  Fixes(const std::vector<double>& sigmas, int seconds, std::uint64_t seed) {
    Noise noise(seed);
    for (std::size_t source = 0; source < sigmas.size(); ++source) voices.push_back(source);
    for (int t = 0; t < seconds; ++t) {
      const double heading = 0.01 * t;
      const Eigen::Vector3d pose(1000 * std::sin(heading), -1000 * std::cos(heading), heading);
      for (std::size_t source = 0; source < sigmas.size(); ++source) {
        Fix fix;
        fix.stamp = Stamp::from_seconds(t + 0.1 * static_cast<double>(source));
        fix.source = static_cast<int>(source);
        fix.antenna_m = {static_cast<double>(source), 0.5};
        fix.position = pose.head<2>() + rotate(heading, fix.antenna_m) + noise.vector(sigmas[source]);
        fixes.push_back(fix);
        poses.push_back(pose);
      }
    }
  }
  void move(int source, double from_s, double to_s, const Eigen::Vector2d& by) {
    for (Fix& fix : fixes)
      if (fix.source == source && fix.stamp.seconds() >= from_s && fix.stamp.seconds() < to_s)
        fix.position += by;
  }
  std::vector<Disagreement> judge() { return reject_contradictions(fixes, poses, voices); }
  [[nodiscard]] std::size_t rejected() const {
    return static_cast<std::size_t>(std::count_if(
        fixes.begin(), fixes.end(), [](const Fix& fix) { return fix.status == FixStatus::rejected; }));
  }
};

/// Samples at 10 Hz at 10 m/s with a slow turn.
std::vector<OdometrySample> samples_of(double speed_scale, double yaw_rate_error, int seconds, Noise& noise) {
  std::vector<OdometrySample> samples;
  for (int i = 0; i <= 10 * seconds; ++i)
    samples.push_back({Stamp::from_seconds(0.1 * i), (1 + speed_scale) * 10 + noise(0.02),
                       0.02 * std::sin(0.01 * i) + yaw_rate_error + noise(0.002)});
  return samples;
}

}  // namespace

TEST_CASE(
    "agreement: each of three receivers that is off by 30 m for 100 s is named and rejected only there") {
  for (const std::vector<double>& sigmas :
       {std::vector<double>{1, 1, 1}, std::vector<double>{0.3, 1, 3}, std::vector<double>{0.05, 1, 1},
        std::vector<double>{0.01, 5, 5}}) {
    for (int wrong = 0; wrong < 3; ++wrong) {
      Fixes fixes(sigmas, 600, 7);
      fixes.move(wrong, 200, 300, {18, -24});
      const std::vector<Disagreement> found = fixes.judge();
      INFO("receiver " << wrong << " of " << sigmas[0] << ", " << sigmas[1] << ", " << sigmas[2] << " m");
      REQUIRE(found.size() == 1);
      CHECK(found[0].source == static_cast<std::size_t>(wrong));
      CHECK(found[0].away_m == Approx(30).margin(4 * 1.25 * 5 / std::sqrt(20)));  // of medians of 20 fixes
      CHECK(found[0].from == Stamp::from_seconds(200));
      CHECK(found[0].to == Stamp::from_seconds(300));
      CHECK(found[0].readings == 100);
      for (const Fix& fix : fixes.fixes) {
        const double t = fix.stamp.seconds();
        const bool is_wrong = fix.source == wrong && t >= 200 && t < 300;
        REQUIRE(fix.status == (is_wrong ? FixStatus::rejected : FixStatus::accepted));
        if (is_wrong) CHECK(fix.reason == "contradicts");
      }
    }
  }
}

TEST_CASE("agreement: nobody is rejected if there are two sources, or two voices") {
  Fixes two({1, 1}, 600, 3);
  two.move(1, 200, 300, {30, 0});
  CHECK(two.judge().empty());
  CHECK(two.rejected() == 0);
  Fixes group({1, 1, 1}, 600, 3);
  group.voices = {0, 1, 1};
  group.move(0, 200, 300, {30, 0});
  CHECK(group.judge().empty());
  CHECK(group.rejected() == 0);
}

TEST_CASE("agreement: if three sources are all apart, nobody is rejected") {
  Fixes fixes({1, 1, 1}, 600, 5);
  fixes.move(0, 200, 300, {30, 0});
  fixes.move(1, 200, 300, {-30, 0});
  CHECK(fixes.judge().empty());
}

TEST_CASE("agreement: two pairs that contradict each other leave it open who is wrong") {
  const std::vector<std::optional<Eigen::Vector2d>> accuracies(4, Eigen::Vector2d(1, 1));
  const auto at = [](double x) { return std::optional(Eigen::Vector2d(x, 0)); };
  CHECK(contradicting({at(0), at(0.5), at(30), at(30.5)}, accuracies).empty());
  CHECK(contradicting({at(0), at(0.5), at(30), at(60)}, accuracies) == std::vector<std::size_t>{2, 3});
  CHECK(contradicting({at(0), at(0.5), std::nullopt, at(60)}, accuracies) == std::vector<std::size_t>{3});
  CHECK(contradicting({at(0), std::nullopt, std::nullopt, at(60)}, accuracies).empty());
}

TEST_CASE("agreement: withheld fixes say nothing and stay withheld") {
  Fixes fixes({1, 1, 1}, 600, 5);
  for (Fix& fix : fixes.fixes)
    if (fix.source == 2) fix.status = FixStatus::withheld;
  fixes.move(0, 200, 300, {30, 0});
  CHECK(fixes.judge().empty());
  CHECK(fixes.rejected() == 0);
}

TEST_CASE("agreement: honest receivers of different accuracy lose less than one fix in a hundred") {
  std::size_t rejected = 0;
  std::size_t all = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Fixes fixes({0.3, 1, 3}, 1000, seed);
    (void)fixes.judge();
    rejected += fixes.rejected();
    all += fixes.fixes.size();
  }
  CHECK(static_cast<double>(rejected) < 0.01 * static_cast<double>(all));
}

TEST_CASE("agreement: accuracies follow from the differences between the sources") {
  const std::array<Eigen::Vector2d, 3> sigmas{Eigen::Vector2d(0.5, 1), Eigen::Vector2d(1, 2),
                                              Eigen::Vector2d(2, 0.7)};
  Noise noise(11);
  constexpr int kWindows = 4000;
  std::vector<Statements> windows;
  for (int w = 0; w < kWindows; ++w) {
    const Eigen::Vector2d common = noise.vector(100);
    Statements window;
    for (const Eigen::Vector2d& sigma : sigmas)
      window.emplace_back(common + noise.vector(1).cwiseProduct(sigma));
    windows.push_back(window);
  }
  const auto found = accuracies_by_agreement(windows);
  REQUIRE(found.size() == 3);
  // A variance from the median of squares has the relative deviation 1.65 sqrt(2 / n), at its efficiency of
  // 37 %. The variance of a source is half of (ab + ac - bc), so the deviations of all three add up at most.
  for (std::size_t a = 0; a < 3; ++a) {
    REQUIRE(found[a].has_value());
    for (int axis = 0; axis < 2; ++axis) {
      double largest = 0;
      for (std::size_t b = 0; b < 3; ++b)
        for (std::size_t c = b + 1; c < 3; ++c)
          largest += std::pow(sigmas.at(b)[axis], 2) + std::pow(sigmas.at(c)[axis], 2);
      const double margin = 4 * 0.5 * 1.65 * std::sqrt(2.0 / kWindows) * largest;
      CHECK(std::pow((*found[a])[axis], 2) == Approx(std::pow(sigmas.at(a)[axis], 2)).margin(margin));
    }
  }
}

TEST_CASE("agreement: a source that shares too few windows with two others has no accuracy") {
  Noise noise(12);
  std::vector<Statements> windows;
  for (int w = 0; w < 100; ++w) {
    Statements window{noise.vector(1), noise.vector(1), noise.vector(1), std::nullopt};
    if (w < 3) window[3] = noise.vector(1);
    windows.push_back(window);
  }
  const auto found = accuracies_by_agreement(windows);
  CHECK(found[0].has_value());
  CHECK_FALSE(found[3].has_value());
}

TEST_CASE("agreement: of three odometries, the one that turns wrongly for 60 s is left out there") {
  Noise noise(21);
  std::vector<std::vector<OdometrySample>> samples = {
      samples_of(0, 0, 600, noise), samples_of(0.003, 0, 600, noise), samples_of(-0.002, 0, 600, noise)};
  for (OdometrySample& sample : samples[1])
    if (sample.stamp.seconds() > 200 && sample.stamp.seconds() < 260) sample.yaw_rate_radps += 0.1;
  const std::vector<Disagreement> found =
      leave_out_contradictions(std::array{&samples[0], &samples[1], &samples[2]});
  REQUIRE(found.size() == 1);
  CHECK(found[0].source == 1);
  CHECK(found[0].from == Stamp::from_seconds(200));
  CHECK(found[0].to == Stamp::from_seconds(260));
  CHECK(found[0].readings == 600);
  CHECK(samples[0].size() == 6001);
  CHECK(samples[1].size() == 6001 - 600);
  CHECK(samples[2].size() == 6001);
  for (const OdometrySample& sample : samples[1])
    CHECK((sample.stamp.seconds() < 200 || sample.stamp.seconds() >= 260));
}

TEST_CASE(
    "agreement: odometries of different scale and bias are honest, and one without samples is no judge") {
  Noise noise(22);
  std::vector<std::vector<OdometrySample>> samples = {samples_of(0.01, 1e-3, 600, noise),
                                                      samples_of(-0.01, 0, 600, noise),
                                                      samples_of(0, -1e-3, 600, noise),
                                                      {}};
  CHECK(leave_out_contradictions(std::array{&samples[0], &samples[1], &samples[2], &samples[3]}).empty());
  for (OdometrySample& sample : samples[0])
    if (sample.stamp.seconds() > 200 && sample.stamp.seconds() < 260) sample.yaw_rate_radps += 0.1;
  CHECK(leave_out_contradictions(std::array{&samples[0], &samples[1], &samples[3]}).empty());
}

TEST_CASE("agreement: a warning names the source, the time and the distance") {
  CHECK(warning_of({.source = 1,
                    .from = Stamp::from_seconds(220),
                    .to = Stamp::from_seconds(300),
                    .away_m = 29.96,
                    .readings = 81},
                   "front", Stamp::from_seconds(100)) ==
        "front contradicts the others, which agree, from 120 to 200 s after the start: by 30.0 m; its 81 "
        "readings there are left out");
}

}  // namespace agreement_test
