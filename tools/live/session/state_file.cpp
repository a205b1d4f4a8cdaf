#include <waymark/tools/live/session/state_file.hpp>

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <nlohmann/json.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/live/session/noise_json.hpp>

namespace waymark::live {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "waymark-live-state";

Json numbers_of(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) rows.push_back(matrix(r, c));
  return rows;
}

Eigen::MatrixXd square_of(const Json& numbers) {
  const auto size = static_cast<Eigen::Index>(std::lround(std::sqrt(static_cast<double>(numbers.size()))));
  if (static_cast<std::size_t>(size * size) != numbers.size()) throw InputError("a covariance is not square");
  Eigen::MatrixXd matrix(size, size);
  for (Eigen::Index r = 0; r < size; ++r)
    for (Eigen::Index c = 0; c < size; ++c)
      matrix(r, c) = numbers.at(static_cast<std::size_t>(r * size + c)).get<double>();
  const Eigen::LLT<Eigen::MatrixXd> root(matrix);
  if (!matrix.allFinite() || root.info() != Eigen::Success)
    throw InputError("a covariance is not positive definite");
  return matrix;
}

}  // namespace

void write_state_file(const std::string& path, const WarmStart& state) {
  Json json{{"schema", kSchema}, {"version", 1}, {"stamp_ns", state.stamp.nanoseconds}};
  json["frame"] = {{"zone", state.frame.zone},
                   {"north", state.frame.north},
                   {"origin_easting_m", state.frame.origin_easting_m},
                   {"origin_northing_m", state.frame.origin_northing_m}};
  if (state.pose) {
    json["pose"] = {(*state.pose)[0], (*state.pose)[1], (*state.pose)[2]};
    json["covariance"] = numbers_of(state.covariance);
  }
  json["states"] = Json::array();
  for (const KnownState& known : state.states)
    json["states"].push_back(
        {{"type", known.tag}, {"value", known.value}, {"covariance", numbers_of(known.covariance)}});
  json["noise"] = Json::array();
  for (const drive::NoiseParameter& parameter : state.noise.parameters)
    json["noise"].push_back({{"source", parameter.source},
                             {"owner", parameter.owner},
                             {"option", parameter.option},
                             {"value", parameter.value}});
  formats::write_file_atomically(path, json.dump(1) + "\n");
}

WarmStart read_state_file(const std::string& path) {
  try {
    const Json json = Json::parse(formats::read_text_file(path, {.check = formats::require_digits(path)}));
    if (json.at("schema") != kSchema || json.at("version") != 1)
      throw InputError("it is no state of this version");
    WarmStart state;
    state.stamp.nanoseconds = json.at("stamp_ns").get<std::int64_t>();
    const Json& frame = json.at("frame");
    state.frame = {frame.at("zone").get<int>(), frame.at("north").get<bool>(),
                   frame.at("origin_easting_m").get<double>(), frame.at("origin_northing_m").get<double>()};
    if (json.contains("pose")) {
      const auto pose = json.at("pose").get<std::vector<double>>();
      if (pose.size() != 3) throw InputError("a pose has three numbers");
      state.pose = Eigen::Vector3d(pose[0], pose[1], pose[2]);
      state.covariance = square_of(json.at("covariance"));
    }
    for (const Json& known : json.at("states"))
      state.states.push_back({known.at("type").get<std::string>(),
                              known.at("value").get<std::vector<double>>(),
                              square_of(known.at("covariance"))});
    if (json.contains("noise")) state.noise = noise_from_json(json.at("noise"));
    return state;
  } catch (const Json::exception& error) {
    throw InputError(path + ": no state of a live run: " + error.what() + "; remove the file to begin anew");
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what() + "; remove the file to begin anew");
  }
}

}  // namespace waymark::live
