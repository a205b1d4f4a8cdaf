#include <waymark/tools/program/jobs/live/live_report.hpp>

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <waymark/version.hpp>

namespace waymark::program {
namespace {

drawing::Figure way_figure(const live::Session& session) {
  drawing::Figure figure{.id = "way",
                         .title = "Way",
                         .description = "Poses as they were said while driving.",
                         .x = {"east", "m"},
                         .y = {"north", "m"},
                         .series = {},
                         .motion = drawing::Motion::map,
                         .geographic = true,
                         .height = 480};
  drawing::Series series{.name = "live"};
  const std::vector<live::Track::Point>& points = session.track().points();
  for (const live::Track::Point& point : points) {
    series.x.push_back(point.place[0]);
    series.y.push_back(point.place[1]);
    series.time.push_back(seconds_between(points.front().stamp, point.stamp));
  }
  figure.series.push_back(std::move(series));
  return figure;
}

/// Stretches of time in a state, as spans behind the curve.
drawing::Series spans_of(const std::vector<live::Track::Point>& points, live::State state,
                         const std::string& name, drawing::Look look) {
  drawing::Series series{.name = name, .mark = drawing::Mark::spans, .look = look};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].state != state) continue;
    const double from_s = seconds_between(points.front().stamp, points[i].stamp);
    const bool goes_on = i > 0 && points[i - 1].state == state;
    if (!goes_on) {
      series.low.push_back(from_s);
      series.high.push_back(from_s);
    }
    series.high.back() =
        i + 1 < points.size() ? seconds_between(points.front().stamp, points[i + 1].stamp) : from_s;
  }
  return series;
}

drawing::Figure radius_figure(const live::Session& session) {
  const std::vector<live::Track::Point>& points = session.track().points();
  drawing::Figure figure{
      .id = "radius",
      .title = "Radius of 95 %",
      .description = fmt::format("The circle that holds the place with 95 %, one point per {} s. Behind it: "
                                 "the time without fixes, and the time above the stated limit.",
                                 session.track().interval_s()),
      .x = {"time", "s"},
      .y = {"radius", "m", true},
      .series = {},
      .motion = drawing::Motion::x,
      .link = "time"};
  for (auto [state, name, look] :
       {std::tuple(live::State::dead_reckoning, "dead reckoning", drawing::Look::withheld),
        std::tuple(live::State::degraded, "degraded", drawing::Look::rejected)}) {
    drawing::Series spans = spans_of(points, state, name, look);
    if (!spans.low.empty()) figure.series.push_back(std::move(spans));
  }
  drawing::Series series{.name = "radius"};
  for (const live::Track::Point& point : points) {
    series.x.push_back(seconds_between(points.front().stamp, point.stamp));
    series.y.push_back(std::max(1e-3, point.radius95_m));
  }
  series.time = series.x;
  figure.series.push_back(std::move(series));
  return figure;
}

drawing::Series histogram(const std::string& name, drawing::Look look, const live::LatencyHistogram& of) {
  drawing::Series series{.name = name, .look = look};
  for (const auto& [upper_us, count] : of.buckets()) {
    series.x.push_back(upper_us);
    series.y.push_back(100 * static_cast<double>(count) / static_cast<double>(of.count()));
  }
  return series;
}

drawing::Figure latency_figure(const live::Latencies& latencies) {
  drawing::Figure figure{
      .id = "latency",
      .title = "Latency",
      .description =
          "How long the work took. Predict: from a sample of the odometry to its lines. Solve: from "
          "a fix to the lines of the corrected pose. Share of all of its kind, in steps of 9 %.",
      .x = {"time", "us", true},
      .y = {"share", "%"},
      .series = {}};
  if (latencies.predict.count() > 0)
    figure.series.push_back(histogram("predict", drawing::Look::first, latencies.predict));
  if (latencies.solve.count() > 0)
    figure.series.push_back(histogram("solve", drawing::Look::second, latencies.solve));
  return figure;
}

text::Table latency_table(const live::Latencies& latencies) {
  text::Table table{.title = "latency",
                    .columns = {"work", "count", "median [us]", "99 % [us]", "99.9 % [us]", "largest [us]"}};
  for (const auto& [name, of] :
       {std::pair("predict", &latencies.predict), std::pair("solve", &latencies.solve)})
    table.rows.push_back({name, fmt::format("{}", of->count()), fmt::format("{:.0f}", of->quantile_us(0.5)),
                          fmt::format("{:.0f}", of->quantile_us(0.99)),
                          fmt::format("{:.0f}", of->quantile_us(0.999)),
                          fmt::format("{:.0f}", of->largest_us())});
  return table;
}

text::Table counts_table(const live::Session& session) {
  const live::Counts& counts = session.estimator().counts();
  text::Table table{.title = "samples", .columns = {"what", "count"}};
  for (const auto& [source, count] : counts.taken)
    table.rows.push_back({source + ": used", fmt::format("{}", count)});
  for (const auto& [reason, count] : counts.refused) table.rows.push_back({reason, fmt::format("{}", count)});
  table.rows.push_back({"late fixes, used", fmt::format("{}", counts.late_fixes)});
  table.rows.push_back({"solutions", fmt::format("{}", counts.solutions)});
  table.rows.push_back({"failures", fmt::format("{}", counts.failures)});
  table.rows.push_back({"resets", fmt::format("{}", counts.resets)});
  table.rows.push_back({"corrupt records", fmt::format("{}", session.corrupt())});
  table.rows.push_back({"lines dropped for slow readers", fmt::format("{}", session.lines_dropped())});
  return table;
}

}  // namespace

drawing::Page live_page(const live::Session& session, const std::string& name) {
  drawing::Page page;
  page.title = name;
  page.subtitle = "live";
  page.footer = std::string("waymark ") + WAYMARK_VERSION;
  const live::Counts& counts = session.estimator().counts();
  page.summary =
      fmt::format("{} solutions, {} failures, {} resets. The run ended in the state {}.", counts.solutions,
                  counts.failures, counts.resets, to_string(session.estimator().state()));
  if (!session.track().points().empty())
    page.sections.push_back({"way", "Way", {way_figure(session), radius_figure(session)}});
  drawing::Section latency{"latency", "Latency", {}};
  if (session.latencies().predict.count() + session.latencies().solve.count() > 0)
    latency.blocks.emplace_back(latency_figure(session.latencies()));
  latency.blocks.emplace_back(latency_table(session.latencies()));
  page.sections.push_back(std::move(latency));
  page.sections.push_back({"samples", "Samples", {counts_table(session)}});
  text::Table events{.title = "the last events", .columns = {"event", "text"}};
  for (const live::Event& event : session.last_events()) events.rows.push_back({event.kind, event.text});
  if (!events.rows.empty()) page.sections.push_back({"events", "Events", {std::move(events)}});
  return page;
}

}  // namespace waymark::program
