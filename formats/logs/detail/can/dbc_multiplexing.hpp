/// Which signal of a DBC message tells where the others are there; private to the parser.
#pragma once

#include <string>

#include <waymark/formats/logs/detail/can/dbc.hpp>

namespace waymark::formats {

/// Ties the signals "m3" of a message that has been read to its multiplexer, where no SG_MUL_VAL_ has done so
/// (there may be only one then). A signal without a clear multiplexer, or whose multiplexer cannot be read,
/// gets a `trouble`. @param path  of the DBC, for messages
void resolve_multiplexing(DbcMessage& message, const std::string& path);

}  // namespace waymark::formats
