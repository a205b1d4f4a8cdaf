/// The DBC files of one log, as one.
#pragma once

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/logs/detail/can/dbc.hpp>

namespace waymark::formats {

/// Joins the DBC files among the companions of a request, in their order. A message that a file has
/// like one before it (id, name and signals) counts once; two different ones of an id stay both.
/// The messages of standard_messages() follow whose ids no file defines.
/// @throws InputError as Dbc::parse()
[[nodiscard]] Dbc dbc_of(const LogRequest& request);

/// Returns the messages that need no DBC because standards define them: the vehicle's speed in answers
/// of OBD-II (ISO 15031-5, service 1, parameter 0D; ids 7E8 and 18DAF110), and speeds, yaw rate,
/// steering, position and course of J1939-71.
[[nodiscard]] const Dbc& standard_messages();

}  // namespace waymark::formats
