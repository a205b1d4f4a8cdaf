/// Noise in JSON: a list of {"source", "owner", "option", "value"}, as in the summary.json of a run.
#pragma once

#include <string>

#include <waymark/tools/drive/estimation/noise.hpp>

namespace waymark::live {

/// @throws Json::exception for entries without these @return values alone
template <typename Json>
[[nodiscard]] drive::NoiseEstimate noise_from_json(const Json& entries) {
  drive::NoiseEstimate noise;
  for (const Json& entry : entries) {
    drive::NoiseParameter& parameter = noise.parameters.emplace_back();
    parameter.source = entry.at("source").template get<std::string>();
    parameter.owner = entry.at("owner").template get<std::string>();
    parameter.option = entry.at("option").template get<std::string>();
    parameter.value = entry.at("value").template get<double>();
  }
  return noise;
}

}  // namespace waymark::live
