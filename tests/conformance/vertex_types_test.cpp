// Every registered vertex type is a manifold: the invariants of concept Vertex.
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "support/registry.hpp"

using namespace waymark;

namespace {

using Numbers = std::vector<double>;

Numbers retract(const VertexType& type, Numbers value, const Numbers& delta) {
  type.retract(value.data(), delta.data());
  return value;
}

Numbers local(const VertexType& type, const Numbers& from, const Numbers& to) {
  Numbers delta(static_cast<std::size_t>(type.tangent_size));
  type.local(from.data(), to.data(), delta.data());
  return delta;
}

double largest_difference(const Numbers& a, const Numbers& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// Random values and values at which angles wrap, normalised by a retraction.
std::vector<Numbers> sample_values(const VertexType& type) {
  constexpr double kPi = std::numbers::pi;
  std::vector<Numbers> values;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> range(-50, 50);
  const auto size = static_cast<std::size_t>(type.value_size);
  for (const double special : {0.0, kPi, -kPi, kPi - 1e-9, -kPi + 1e-9, std::nextafter(kPi, 0), 1e7}) {
    values.emplace_back(size, special);
  }
  for (int i = 0; i < 50; ++i) {
    Numbers& value = values.emplace_back(size);
    for (double& x : value) x = range(random);
  }
  const Numbers zero(static_cast<std::size_t>(type.tangent_size), 0.0);
  for (Numbers& value : values) value = retract(type, value, zero);
  return values;
}

}  // namespace

TEST_CASE("every vertex type: retraction by zero is the identity, to the bit") {
  for (const auto& [type, origin] : waymark_test::registry().vertices()) {
    INFO(type.tag);
    const Numbers zero(static_cast<std::size_t>(type.tangent_size), 0.0);
    for (const Numbers& value : sample_values(type)) CHECK(retract(type, value, zero) == value);
  }
}

TEST_CASE("every vertex type: local(v, v) is zero") {
  for (const auto& [type, origin] : waymark_test::registry().vertices()) {
    INFO(type.tag);
    const Numbers zero(static_cast<std::size_t>(type.tangent_size), 0.0);
    for (const Numbers& value : sample_values(type)) CHECK(local(type, value, value) == zero);
  }
}

TEST_CASE("every vertex type: local inverts retract, also across the wrap") {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const auto& [type, origin] : waymark_test::registry().vertices()) {
    INFO(type.tag);
    for (const Numbers& value : sample_values(type)) {
      for (const double size : {1e-9, 1e-3, 1.0, 3.0}) {
        Numbers delta(static_cast<std::size_t>(type.tangent_size));
        for (double& d : delta) d = size * unit(random);
        const double scale = 4 + largest_difference(value, Numbers(value.size(), 0.0));
        CHECK(largest_difference(local(type, value, retract(type, value, delta)), delta) < 1e-15 * scale);
      }
    }
  }
}

TEST_CASE("every vertex type: retract inverts local between any two values") {
  for (const auto& [type, origin] : waymark_test::registry().vertices()) {
    INFO(type.tag);
    const std::vector<Numbers> values = sample_values(type);
    const Numbers zero(static_cast<std::size_t>(type.tangent_size), 0.0);
    for (const Numbers& from : values) {
      for (const Numbers& to : values) {
        // Compared in the chart: -pi + 1e-9 and pi are neighbours.
        const Numbers reached = retract(type, from, local(type, from, to));
        const Numbers origin_value(from.size(), 0.0);
        const double scale =
            4 + largest_difference(from, origin_value) + largest_difference(to, origin_value);
        CHECK(largest_difference(local(type, to, reached), zero) < 4e-15 * scale);
      }
    }
  }
}

TEST_CASE("every vertex type: as many names as numbers, and a tag without blanks") {
  for (const auto& [type, origin] : waymark_test::registry().vertices()) {
    INFO(type.tag);
    CHECK(type.value_names.size() == static_cast<std::size_t>(type.value_size));
    CHECK(type.tag.find_first_of(" \t#") == std::string::npos);
    CHECK_FALSE(type.tag.empty());
  }
}

TEST_CASE("VERTEX_SE2: its heading stays within half a turn") {
  const VertexType& type = *waymark_test::registry().find_vertex("VERTEX_SE2");
  constexpr double kPi = std::numbers::pi;
  for (double heading = -30; heading < 30; heading += 0.37) {
    const Numbers value = retract(type, {1, 2, 0}, {0, 0, heading});
    CHECK(value[2] > -kPi);
    CHECK(value[2] <= kPi);
    CHECK(std::cos(value[2]) == Approx(std::cos(heading)).margin(1e-14));
    CHECK(std::sin(value[2]) == Approx(std::sin(heading)).margin(1e-14));
  }
  CHECK(retract(type, {0, 0, -kPi}, {0, 0, 0})[2] == kPi);
}

TEST_CASE("every vertex type: its rigid motion is the derivative of moving its place") {
  // A turn by a about the centre takes the place p to c + R(a)(p - c); the columns are scaled by 1/extent.
  for (const auto& [type, origin] : waymark_test::registry().vertices()) {
    INFO(type.tag);
    if (type.rigid_motion == nullptr) continue;
    const Eigen::Vector2d centre(4, -3);
    constexpr double kExtent = 7;
    for (const Numbers& value : sample_values(type)) {
      if (std::abs(value[0]) > 1e6) continue;
      Eigen::MatrixXd columns(type.tangent_size, 3);
      type.rigid_motion(value.data(), centre, kExtent, columns.data());
      for (int motion = 0; motion < 3; ++motion) {
        constexpr double kStep = 1e-5;
        Numbers delta(static_cast<std::size_t>(type.tangent_size));
        for (int i = 0; i < type.tangent_size; ++i)
          delta[static_cast<std::size_t>(i)] = kStep * columns(i, motion);
        const Eigen::Vector2d p = type.position(value.data());
        Eigen::Vector2d expected = p;
        if (motion < 2) {
          expected[motion] += kStep;
        } else {
          expected = centre + Eigen::Rotation2Dd(kStep / kExtent) * (p - centre);
        }
        CHECK((type.position(retract(type, value, delta).data()) - expected).norm() < 1e-9);
      }
    }
  }
}
