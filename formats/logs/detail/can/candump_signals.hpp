/// Which signal of a DBC gives which quantity of a stream; private to the candump reader.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/can/dbc.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>

namespace waymark::formats {

/// A quantity tied to a signal.
struct BoundSignal {
  std::size_t quantity = 0;  ///< index in the stream's quantities
  std::size_t message = 0;   ///< index in the DBC
  std::size_t signal = 0;    ///< index in the message
  std::string interface;     ///< only frames of this one; empty: of any
  double factor = 1;         ///< quantity = factor * value + offset, sense included
  double offset = 0;
  int time_power = 0;  ///< of `gnss_time`, instead of the factor: its unit is 10^time_power s
};

/// Quantities that signals can give: those of the stream but for `time`, which the log stamps. Readings are
/// in the order of the request.
/// @throws UsageError for an odometry request without channels, and as quantities()
[[nodiscard]] std::vector<Quantity> signal_quantities(const LogRequest& request);

/// Ties every quantity in `request.columns` to its signal: "SIGNAL", "MESSAGE.SIGNAL", or either behind an
/// interface, "can0:SIGNAL". Units: as stated, else by the DBC, which is noted.
/// @param place  begins every message: "drive.log: "
/// @throws InputError for an unknown quantity, unit, convention or signal, a signal name that several
/// messages have, a required quantity without a signal, a unit that neither request nor DBC tell
[[nodiscard]] std::vector<BoundSignal> bind_signals(const Dbc& dbc, const std::vector<Quantity>& quantities,
                                                    const LogRequest& request, const std::string& place,
                                                    std::vector<std::string>& notes);

}  // namespace waymark::formats
