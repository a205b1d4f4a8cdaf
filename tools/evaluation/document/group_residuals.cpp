#include <waymark/tools/evaluation/document/group_residuals.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

#include <waymark/tools/evaluation/document/residuals.hpp>
#include <waymark/tools/text/json_number.hpp>
#include <waymark/tools/text/number_text.hpp>

namespace waymark::evaluation {
namespace {

constexpr double kHalfWeight = 0.5;
constexpr double kToDegrees = 180 / std::numbers::pi;

/// Measures single edges of a graph.
class Edges {
 public:
  explicit Edges(const Graph& graph) : graph_(graph) {}

  [[nodiscard]] GroupedMeasurement measure(const MeasurementGroups::Member& member, QuantityResiduals& sum) {
    const EdgeBatchBase& batch = graph_.batch(member.edge.batch);
    batch.linearize_edge(member.edge.edge, graph_.view(), error_, jacobians_);
    const double squared = error_.dot(batch.information(member.edge.edge) * error_);
    const Loss* loss = batch.loss(member.edge.edge);
    GroupedMeasurement measured{.stamp = latest_stamp(graph_, batch.vertices(member.edge.edge)),
                                .quantity = member.quantity,
                                .group = member.group,
                                .residual = error_[0],
                                .weight = loss != nullptr ? loss->at(std::max(0.0, squared)).weight : 1,
                                .signal = member.signal,
                                .bearing_rad = member.bearing_rad,
                                .elevation_rad = member.elevation_rad};
    sum.add({.measurements = 1,
             .rms = std::abs(measured.residual),
             .whitened_rms = std::sqrt(std::max(0.0, squared) / static_cast<double>(error_.size())),
             .robust = loss != nullptr ? 1U : 0U,
             .down_weighted = measured.weight < kHalfWeight ? 1U : 0U,
             .weight = measured.weight});
    return measured;
  }

 private:
  const Graph& graph_;
  Eigen::VectorXd error_;
  std::vector<Eigen::MatrixXd> jacobians_;
};

/// Returns the groups in the order of a report: families as they came, names in order.
std::vector<std::size_t> order_of(const std::vector<MeasurementGroups::Group>& groups) {
  std::vector<std::string> families;
  std::vector<std::size_t> family_of;
  for (const MeasurementGroups::Group& group : groups) {
    const auto known = std::find(families.begin(), families.end(), group.family);
    family_of.push_back(static_cast<std::size_t>(known - families.begin()));
    if (known == families.end()) families.push_back(group.family);
  }
  std::vector<std::size_t> order(groups.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(family_of[a], groups[a].name) < std::tie(family_of[b], groups[b].name);
  });
  return order;
}

/// Fills the mean signal and the range of elevations.
void add_summary(std::span<const GroupedMeasurement> measurements, std::vector<GroupResiduals>& groups) {
  std::vector<double> signals(groups.size(), 0);
  std::vector<double> counts(groups.size(), 0);
  for (const GroupedMeasurement& measured : measurements) {
    GroupResiduals& group = groups[measured.group];
    group.lowest_rad = std::fmin(group.lowest_rad, measured.elevation_rad);
    group.highest_rad = std::fmax(group.highest_rad, measured.elevation_rad);
    if (std::isnan(measured.signal)) continue;
    signals[measured.group] += measured.signal;
    ++counts[measured.group];
  }
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (counts[g] > 0) groups[g].signal = signals[g] / counts[g];
}

GroupedResiduals residuals_of(Edges& edges, const GroupsOfSource& source) {
  const MeasurementGroups& told = source.groups;
  GroupedResiduals result{.source = source.source,
                          .one = told.one,
                          .many = told.many,
                          .signal_name = told.signal_name,
                          .signal_unit = told.signal_unit,
                          .quantities = told.quantities,
                          .groups = {},
                          .measurements = {}};
  std::vector<std::size_t> place(told.groups.size());
  for (const std::size_t g : order_of(told.groups)) {
    place[g] = result.groups.size();
    result.groups.push_back({.name = told.groups[g].name,
                             .family = told.groups[g].family,
                             .quantities = std::vector<QuantityResiduals>(told.quantities.size())});
  }
  result.measurements.reserve(told.members.size());
  for (const MeasurementGroups::Member& member : told.members) {
    const std::size_t group = place[member.group];
    result.measurements.push_back(edges.measure(member, result.groups[group].quantities[member.quantity]));
    result.measurements.back().group = group;
  }
  std::stable_sort(result.measurements.begin(), result.measurements.end(),
                   [](const GroupedMeasurement& a, const GroupedMeasurement& b) {
                     return std::tie(a.group, a.stamp) < std::tie(b.group, b.stamp);
                   });
  add_summary(result.measurements, result.groups);
  return result;
}

/// Returns the mean of two means, or of two rms by their squares.
double mean_of_both(double a, std::size_t n, double b, std::size_t m) {
  if (n == 0 || m == 0) return n == 0 ? b : a;
  return (static_cast<double>(n) * a + static_cast<double>(m) * b) / static_cast<double>(n + m);
}

std::string share_text(double share) {
  return std::isnan(share) ? "no loss" : text::decimals(100 * share, 1);
}

/// Returns the columns of each quantity: number, rms, down-weighted.
text::Row quantity_headings(const GroupedResiduals& residuals) {
  text::Row headings;
  for (const auto& [name, unit] : residuals.quantities) {
    headings.push_back(name + "s");
    headings.push_back("rms [" + unit + "]");
    headings.push_back("whitened rms");
    headings.push_back("down-weighted [%]");
  }
  return headings;
}

void add_cells(const QuantityResiduals& of, text::Row& row) {
  row.push_back(fmt::to_string(of.measurements));
  row.push_back(text::readable(of.rms));
  row.push_back(text::readable(of.whitened_rms));
  row.push_back(of.measurements == 0 ? "-" : share_text(of.share_down_weighted()));
}

nlohmann::ordered_json to_json(const GroupResiduals& group, const GroupedResiduals& residuals) {
  nlohmann::ordered_json quantities = nlohmann::ordered_json::array();
  for (std::size_t q = 0; q < group.quantities.size(); ++q) {
    const QuantityResiduals& of = group.quantities[q];
    if (of.measurements == 0) continue;
    quantities.push_back({{"quantity", residuals.quantities[q].name},
                          {"unit", residuals.quantities[q].unit},
                          {"measurements", of.measurements},
                          {"rms", text::number_or_null(of.rms)},
                          {"whitened_rms", text::number_or_null(of.whitened_rms)},
                          {"robust", of.robust},
                          {"down_weighted", of.down_weighted},
                          {"mean_weight", text::number_or_null(of.weight)}});
  }
  return {{"name", group.name},
          {"family", group.family},
          {"mean_signal", text::number_or_null(group.signal)},
          {"lowest_elevation_rad", text::number_or_null(group.lowest_rad)},
          {"highest_elevation_rad", text::number_or_null(group.highest_rad)},
          {"quantities", std::move(quantities)}};
}

}  // namespace

double QuantityResiduals::share_down_weighted() const {
  return robust > 0 ? static_cast<double>(down_weighted) / static_cast<double>(measurements) : kUndefined;
}

void QuantityResiduals::add(const QuantityResiduals& other) {
  const std::size_t n = measurements;
  const std::size_t m = other.measurements;
  rms = std::sqrt(mean_of_both(rms * rms, n, other.rms * other.rms, m));
  whitened_rms =
      std::sqrt(mean_of_both(whitened_rms * whitened_rms, n, other.whitened_rms * other.whitened_rms, m));
  weight = mean_of_both(weight, n, other.weight, m);
  measurements += m;
  robust += other.robust;
  down_weighted += other.down_weighted;
}

std::vector<std::string> GroupedResiduals::families() const {
  std::vector<std::string> names;
  for (const GroupResiduals& group : groups)
    if (names.empty() || names.back() != group.family) names.push_back(group.family);
  return names;
}

std::vector<GroupedResiduals> residuals_by_group(const Graph& graph, std::span<const GroupsOfSource> groups) {
  Edges edges(graph);
  std::vector<GroupedResiduals> all;
  for (const GroupsOfSource& source : groups) all.push_back(residuals_of(edges, source));
  return all;
}

text::Table group_table(const GroupedResiduals& residuals) {
  const bool families = residuals.families() != std::vector<std::string>{""};
  const bool elevations = std::any_of(residuals.groups.begin(), residuals.groups.end(),
                                      [](const GroupResiduals& of) { return !std::isnan(of.lowest_rad); });
  text::Table table{.columns = {residuals.one}};
  if (families) table.columns.push_back("of");
  for (std::string& heading : quantity_headings(residuals)) table.columns.push_back(std::move(heading));
  if (!residuals.signal_name.empty())
    table.columns.push_back("mean " + residuals.signal_name + " [" + residuals.signal_unit + "]");
  if (elevations) table.columns.push_back("elevation [deg]");
  for (const GroupResiduals& group : residuals.groups) {
    text::Row row{group.name};
    if (families) row.push_back(group.family);
    for (const QuantityResiduals& of : group.quantities) add_cells(of, row);
    if (!residuals.signal_name.empty()) row.push_back(text::decimals(group.signal, 1));
    if (elevations)
      row.push_back(text::decimals(kToDegrees * group.lowest_rad, 0) + " to " +
                    text::decimals(kToDegrees * group.highest_rad, 0));
    table.rows.push_back(std::move(row));
  }
  return table;
}

text::Table family_table(const GroupedResiduals& residuals, const std::string& label) {
  text::Table table{.columns = {residuals.many + " of " + residuals.source, "number"}};
  if (!label.empty()) table.columns.front() = label + ", " + table.columns.front();
  for (std::string& heading : quantity_headings(residuals)) table.columns.push_back(std::move(heading));
  for (const std::string& family : residuals.families()) {
    std::size_t number = 0;
    std::vector<QuantityResiduals> sums(residuals.quantities.size());
    for (const GroupResiduals& group : residuals.groups) {
      if (group.family != family) continue;
      ++number;
      for (std::size_t q = 0; q < sums.size(); ++q) sums[q].add(group.quantities[q]);
    }
    text::Row row{family.empty() ? "all" : family, fmt::to_string(number)};
    for (const QuantityResiduals& sum : sums) add_cells(sum, row);
    table.rows.push_back(std::move(row));
  }
  return table;
}

nlohmann::ordered_json grouped_residuals_json(std::span<const GroupedResiduals> residuals) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const GroupedResiduals& of : residuals) {
    nlohmann::ordered_json groups = nlohmann::ordered_json::array();
    for (const GroupResiduals& group : of.groups) groups.push_back(to_json(group, of));
    json.push_back({{"source", of.source},
                    {"one", of.one},
                    {"signal", of.signal_name},
                    {"signal_unit", of.signal_unit},
                    {"groups", std::move(groups)}});
  }
  return json;
}

}  // namespace waymark::evaluation
