/// Finds the multiplexer of each signal of a DBC message; private to the parser.
#pragma once

#include <string>

#include <waymark/formats/logs/detail/can/dbc.hpp>

namespace waymark::formats {

/// Binds the signals "m3" of a message to its multiplexer after the message has been read. Signals
/// that SG_MUL_VAL_ has bound are left alone. For all others the message may have only one
/// multiplexer. A signal gets a `trouble` if its multiplexer is ambiguous or unreadable. @param
/// path of the DBC, for messages
void resolve_multiplexing(DbcMessage& message, const std::string& path);

}  // namespace waymark::formats
