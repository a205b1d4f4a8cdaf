/// Whether the only receiver smooths its positions, as ReceiverFilter does. Its fixes then seem late where the vehicle
/// pulls away and turns, although they are not, and are off together for some seconds.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

struct ReceiverSmoothing {
  double time_s = 0;  ///< of its filter
  double sigma_s = 0;
};

/// Finds the time of the filter that makes the fixes most probable, with all states that the settings estimate, on a
/// sample of the drive. It is a proposal, and the evidence decides.
/// @param placed with the time offsets of its fixes, and what is taken for its smoothing @param settings with the noise
/// @param between called between its fusions; what it throws ends the search. Empty: nothing is called
/// @return empty if there are several receivers, if half chi2 falls by less than 15 (more where no
/// state explains the fixes), or if the time is beyond 10 s
[[nodiscard]] std::optional<ReceiverSmoothing> find_smoothing(const PlacedDrive& placed,
                                                              std::span<const PreparedSensor> sensors,
                                                              const FusionSettings& settings,
                                                              const TypeRegistry& registry,
                                                              const std::function<void()>& between = {});

/// Returns the warning about a receiver that smooths. @param receiver its name
[[nodiscard]] std::string warning_of(const ReceiverSmoothing& smoothing, const std::string& receiver);

}  // namespace waymark::drive
