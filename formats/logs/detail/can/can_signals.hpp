/// Maps signals of a DBC to the quantities of a stream; private to the candump reader.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/can/dbc.hpp>
#include <waymark/formats/logs/detail/common/quantity.hpp>

namespace waymark::formats {

/// A quantity and its signal.
struct BoundSignal {
  std::size_t quantity = 0;  ///< index in the stream's quantities
  std::size_t message = 0;   ///< index in the DBC
  std::size_t signal = 0;    ///< index in the message
  std::string interface;     ///< only frames of this interface; empty: of any interface
  double factor = 1;         ///< quantity = factor * value + offset; the factor includes sense and scale
  double offset = 0;
  std::optional<double> missing;  ///< a value that means "no value"
  int time_power = 0;             ///< for `gnss_time`, in place of the factor: the unit is 10^time_power s
};

/// Returns the quantities that signals can give: those of the stream except `time`, which comes
/// from the log. Readings are in the order of the request.
/// @throws UsageError for an odometry request without channels, and as quantities()
[[nodiscard]] std::vector<Quantity> signal_quantities(const LogRequest& request);

/// Binds every quantity in `request.columns` to its signal: "SIGNAL", "MESSAGE.SIGNAL", or either
/// of them after an interface, "can0:SIGNAL". If the request states no unit, the unit of the DBC is
/// used, and a note says so.
/// @param place first words of every message: "drive.log: "
/// @throws InputError for an unknown quantity, unit, convention or signal, a signal name that
/// several messages have, a required quantity without a signal, and a unit that neither request
/// nor DBC state
[[nodiscard]] std::vector<BoundSignal> bind_signals(const Dbc& dbc, const std::vector<Quantity>& quantities,
                                                    const LogRequest& request, const std::string& place,
                                                    std::vector<std::string>& notes);

}  // namespace waymark::formats
