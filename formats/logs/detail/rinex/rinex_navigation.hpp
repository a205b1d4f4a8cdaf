/// RINEX navigation files: broadcast ephemerides.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/formats/satellites/ephemerides.hpp>

namespace waymark::formats {

/// Reads a navigation file of RINEX 2 (GPS, GLONASS) or 3 (those, Galileo, BeiDou) and adds what it holds. The week of
/// an ephemeris is that of its clock's date, because the stated week is often counted modulo 1024. Records of other
/// systems are skipped.
/// @param notes gets a sentence if records could not be used
/// @throws InputError "brdc.nav:12: ..." if the file is no navigation file, ends in its header, or holds no ephemeris
void read_rinex_navigation(const CompanionFile& file, satellites::Ephemerides& ephemerides,
                           std::vector<std::string>& notes);

}  // namespace waymark::formats
