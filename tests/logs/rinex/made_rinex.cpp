#include "logs/rinex/made_rinex.hpp"

#include <fmt/format.h>

namespace waymark_test {

std::string rinex_header_line(std::string content, std::string_view label) {
  content.resize(60, ' ');
  return content + std::string(label) + "\n";
}

std::string made_rinex_header() {
  return rinex_header_line("     3.03           OBSERVATION DATA    M", "RINEX VERSION / TYPE") +
         rinex_header_line("  6378137.0000        0.0000        0.0000", "APPROX POSITION XYZ") +
         rinex_header_line("G    4 C1C L1C D1C S1C", "SYS / # / OBS TYPES") +
         rinex_header_line("", "END OF HEADER");
}

std::string made_rinex_observations(int epochs) {
  std::string text = made_rinex_header();
  for (int second = 0; second < epochs; ++second)
    text += fmt::format(
        "> 2016 06 05 00 {:02} {:10.7f}  0  1\n"
        "G05  20182000.000 8 106055000.000 8         0.000          49.000\n",
        second / 60, static_cast<double>(second % 60));
  return text;
}

std::string made_rinex_navigation() {
  const auto numbers = [](std::string_view begin, std::initializer_list<double> values) {
    std::string line(begin);
    for (const double value : values) line += fmt::format("{:19.12E}", value);
    return line + "\n";
  };
  constexpr const char* kBlank = "    ";
  constexpr double kSqrtA = 5153.7;  // sqrt(m)
  return rinex_header_line("     3.03           N: GNSS NAV DATA    G", "RINEX VERSION / TYPE") +
         rinex_header_line("", "END OF HEADER") + numbers("G05 2016 06 05 00 00 00", {0, 0, 0}) +
         numbers(kBlank, {0, 0, 0, 0}) + numbers(kBlank, {0, 0, 0, kSqrtA}) + numbers(kBlank, {0, 0, 0, 0}) +
         numbers(kBlank, {0, 0, 0, 0}) + numbers(kBlank, {0, 0, 1900, 0}) + numbers(kBlank, {0, 0, 0, 0}) +
         numbers(kBlank, {0, 0, 0, 0});
}

}  // namespace waymark_test
