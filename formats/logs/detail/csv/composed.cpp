#include <waymark/formats/logs/detail/csv/composed.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/formats/logs/detail/common/record_fields.hpp>

namespace waymark::formats {
namespace {

double length(const double* east_north) {
  return std::hypot(east_north[0], east_north[1]);
}

double or_none(const double* east_north, double angle) {
  return east_north[0] == 0 && east_north[1] == 0 ? kNoNumber : angle;
}

double from_east(const double* east_north) {
  return or_none(east_north, std::atan2(east_north[1], east_north[0]));
}

double from_north(const double* east_north) {
  return or_none(east_north, std::atan2(east_north[0], east_north[1]));
}

/// The direction of the x axis of a body whose attitude is (x, y, z, w) in axes east, north, up: the first column
/// of the rotation matrix (Diebel, Representing Attitude, 2006, equation 125).
double of_quaternion(const double* q) {
  const std::array<double, 2> forward{q[3] * q[3] + q[0] * q[0] - q[1] * q[1] - q[2] * q[2],
                                      2 * (q[0] * q[1] + q[3] * q[2])};
  return from_east(forward.data());
}

double itself(const double* piece) {
  return *piece;
}

constexpr std::array<std::string_view, 2> kVelocity{"velocity_east", "velocity_north"};
constexpr std::array<std::string_view, 2> kAxis{"heading_east", "heading_north"};
constexpr std::array<std::string_view, 4> kQuaternion{"quaternion_x", "quaternion_y", "quaternion_z",
                                                      "quaternion_w"};
constexpr std::array<std::string_view, 3> kEcef{"ecef_x", "ecef_y", "ecef_z"};
constexpr std::array<std::string_view, 1> kWay{"distance_step"};
constexpr std::array<std::string_view, 1> kTurn{"heading_step"};

/// A way to compose a quantity.
struct Composition {
  std::string_view quantity;
  std::span<const std::string_view> pieces;
  double (*formula)(const double*) = nullptr;
  bool adds_up = false;
};

constexpr std::array kCompositions{
    Composition{"speed", kVelocity, length},     Composition{"course", kVelocity, from_east},
    Composition{"heading", kAxis, from_east},    Composition{"heading", kQuaternion, of_quaternion},
    Composition{"heading", kTurn, itself, true}, Composition{"distance", kWay, itself, true}};

}  // namespace

std::vector<Quantity> table_quantities(const LogRequest& request) {
  std::vector<Quantity> all = quantities(request);
  if (request.stream == StreamKind::sensor) return all;
  all.push_back(*find_piece("time_fraction"));
  if (find_quantity(all, "easting") != nullptr)
    for (const std::string_view name : kEcef) all.push_back(*find_piece(name));
  for (const Composition& way : kCompositions) {
    // Only channels can come in steps.
    const bool fits = find_quantity(all, way.quantity) != nullptr &&
                      (!request.readings.empty() || (!way.adds_up && request.stream != StreamKind::odometry));
    for (const std::string_view name : way.pieces)
      if (fits && find_quantity(all, name) == nullptr) all.push_back(*find_piece(name));
  }
  return all;
}

bool names_columns_of(const LogRequest& request, std::string_view quantity) {
  const auto names = [&](std::string_view name) { return request.columns.contains(std::string(name)); };
  return names(quantity) ||
         std::any_of(kCompositions.begin(), kCompositions.end(), [&](const Composition& way) {
           return way.quantity == quantity && names(way.pieces.front());
         });
}

Composed::Composed(std::string_view quantity, StreamKind stream, const CsvColumns& columns,
                   const std::string& path) {
  for (const Composition& way : kCompositions) {
    if (way.quantity != quantity || !pieces_.empty()) continue;
    for (const std::string_view name : way.pieces)
      if (const BoundColumn* column = columns.find(name)) pieces_.push_back(column);
    if (!pieces_.empty() && pieces_.size() < way.pieces.size())
      throw InputError(fmt::format("{}: the {} has only a part of its columns: {} belong together", path,
                                   quantity, joined(way.pieces)));
    formula_ = quantity == "course" && stream == StreamKind::gnss ? from_north : way.formula;
    adds_up_ = way.adds_up;
  }
}

double Composed::value(const std::function<double(const BoundColumn*)>& number) {
  std::array<double, kQuaternion.size()> pieces{};
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    pieces[i] = number(pieces_[i]);
    if (std::isnan(pieces[i])) return kNoNumber;
  }
  if (!adds_up_) return formula_(pieces.data());
  return sum_ += pieces[0];
}

}  // namespace waymark::formats
