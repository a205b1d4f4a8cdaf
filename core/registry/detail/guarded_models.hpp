/// The models of plugins, as the registry gives them out: each call is guarded (core/base/guard.hpp).
#pragma once

#include <memory>
#include <string>

#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/linear/linear_solver.hpp>
#include <waymark/core/optimize/algorithm.hpp>

namespace waymark {

/// Who is called, for messages.
struct Guarded {
  std::string origin;  ///< the plugin
  std::string kind;    ///< "sensor model"
  std::string name;

  /// Returns "plugin 'uwb': sensor model 'uwb'".
  [[nodiscard]] std::string text() const;
};

[[nodiscard]] std::unique_ptr<OdometryModel> guarded_model(Guarded who, std::unique_ptr<OdometryModel> model);
[[nodiscard]] std::unique_ptr<GnssModeling> guarded_model(Guarded who, std::unique_ptr<GnssModeling> model);
[[nodiscard]] std::unique_ptr<SensorModel> guarded_model(Guarded who, std::unique_ptr<SensorModel> model);
[[nodiscard]] std::unique_ptr<Algorithm> guarded_model(Guarded who, std::unique_ptr<Algorithm> model);
[[nodiscard]] std::unique_ptr<LinearSolver> guarded_model(Guarded who, std::unique_ptr<LinearSolver> model);

}  // namespace waymark
