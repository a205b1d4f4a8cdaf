// The random numbers of simulated drives against theory, with fixed seeds.
#include <catch2/catch.hpp>

#include <cmath>

#include <waymark/tools/simulation/random.hpp>

namespace simulation_random_test {

using namespace waymark;
using namespace waymark::simulation;

namespace {

template <typename Process>
std::vector<double> draw(Process&& process, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(process());
  return values;
}

double mean_product(const std::vector<double>& values, std::size_t lag) {
  double sum = 0;
  for (std::size_t i = lag; i < values.size(); ++i) sum += values[i - lag] * values[i];
  return sum / static_cast<double>(values.size() - lag);
}

}  // namespace

TEST_CASE("simulation: the generator is its authors' xoshiro256++") {
  // Reference values of the authors' C code for the state 1, 2, 3, 4.
  RandomStream random(std::array<std::uint64_t, 4>{1, 2, 3, 4});
  for (const std::uint64_t expected :
       {41943041ULL, 58720359ULL, 3588806011781223ULL, 3591011842654386ULL, 9228616714210784205ULL,
        9973669472204895162ULL, 14011001112246962877ULL, 12406186145184390807ULL})
    CHECK(random.bits() == expected);
}

TEST_CASE("simulation: uniform, normal and exponential numbers have their moments") {
  constexpr std::size_t n = 200'000;
  RandomStream random(1, 1);
  double sum = 0;
  double squares = 0;
  double fourth = 0;
  double exponential = 0;
  double uniform = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double z = random.normal();
    sum += z;
    squares += z * z;
    fourth += z * z * z * z;
    exponential += random.exponential();
    uniform += random.uniform();
  }
  const double root = std::sqrt(static_cast<double>(n));
  CHECK(sum / n == Approx(0).margin(4 / root));
  CHECK(squares / n == Approx(1).margin(4 * std::sqrt(2) / root));
  CHECK(fourth / n == Approx(3).margin(4 * std::sqrt(96) / root));
  CHECK(exponential / n == Approx(1).margin(4 / root));
  CHECK(uniform / n == Approx(0.5).margin(4 / std::sqrt(12) / root));
}

TEST_CASE("simulation: streams of one seed are not correlated") {
  RandomStream a(7, 1);
  RandomStream b(7, 2);
  constexpr int n = 100'000;
  double product = 0;
  for (int i = 0; i < n; ++i) product += a.normal() * b.normal();
  CHECK(product / n == Approx(0).margin(4 / std::sqrt(n)));
}

TEST_CASE("simulation: the Gauss-Markov part decays as exp(-dt / tau)") {
  RandomStream random(3, 1);
  GaussMarkov process(30);
  const std::vector<double> values = draw([&] { return process.next(1, random); }, 400'000);
  // A correlation time of 30 s leaves 400000 / 60 independent values.
  constexpr double margin = 4 * 1.5 / 81;
  CHECK(mean_product(values, 0) == Approx(1).margin(margin));
  for (const std::size_t lag : {1U, 10U, 60U}) {
    INFO(lag);
    CHECK(mean_product(values, lag) == Approx(std::exp(-static_cast<double>(lag) / 30)).margin(margin));
  }
}

TEST_CASE("simulation: smoothed by the receiver the part keeps its sigma and decays as the cascade does") {
  RandomStream random(4, 1);
  SmoothedGaussMarkov process(30, 4, 1);
  const std::vector<double> values = draw([&] { return process.next(random); }, 400'000);
  const double phi = std::exp(-1.0 / 30);
  const double a = std::exp(-1.0 / 4);
  const auto theory = [&](double k) {
    return (std::pow(phi, k + 1) * (1 - a * a) - std::pow(a, k + 1) * (1 - phi * phi)) /
           ((phi - a) * (1 + phi * a));
  };
  CHECK(theory(0) == Approx(1).epsilon(1e-12));
  for (const std::size_t lag : {0U, 1U, 10U, 60U}) {
    INFO(lag);
    CHECK(mean_product(values, lag) == Approx(theory(static_cast<double>(lag))).margin(0.08));
  }
  // The start is stationary too.
  double squares = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    RandomStream fresh(seed, 9);
    const double first = SmoothedGaussMarkov(30, 4, 1).next(fresh);
    squares += first * first;
  }
  CHECK(squares / 4000 == Approx(1).margin(4 * std::sqrt(2.0 / 4000)));
}

}  // namespace simulation_random_test
