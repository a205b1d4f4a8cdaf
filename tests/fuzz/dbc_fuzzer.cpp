// A DBC file of any bytes, and a candump log of any bytes that is read by it: the two parted by the first
// zero.
#include <waymark/core/base/error.hpp>
#include <waymark/formats/logs/channels.hpp>
#include <waymark/formats/logs/detail/can/dbc.hpp>
#include <waymark/formats/logs/log_readers.hpp>

#include "fuzz_input.hpp"
#include "invariants.hpp"
#include "targets.hpp"

namespace waymark_fuzz {
namespace {

/// Every signal out of one frame: none may be undefined.
void read_signals(const std::string& text) {
  const waymark::formats::Dbc dbc = waymark::formats::Dbc::parse(text, "fuzz.dbc");
  waymark::formats::CanData frame;
  frame.size = waymark::formats::kMostFrameBytes;
  for (std::size_t i = 0; i < frame.size; ++i) frame.bytes[i] = static_cast<std::uint8_t>(0x9E * i + 7);
  for (const waymark::formats::DbcMessage& message : dbc.messages) {
    for (const waymark::formats::DbcSignal& signal : message.signals) {
      if (!signal.trouble.empty() || signal.bytes_needed() > frame.size) continue;
      if (!message.holds(signal, frame)) continue;
      (void)signal.value(frame);
      (void)signal.integer(frame, 1'000'000'000);
    }
  }
}

}  // namespace

void fuzz_dbc(std::string_view, const std::uint8_t* bytes, std::size_t size) {
  FuzzInput input = fuzz_input("candump", bytes, size);
  const std::size_t end = std::min(input.log.find('\0'), input.log.size());
  const std::string dbc = input.log.substr(0, end);
  const std::string log =
      end < input.log.size()
          ? input.log.substr(end + 1)
          : "(1.5) can0 0AA#0123456789ABCDEF\n(1.6) can0 024#FFFF\n(1.7) can0 003#0011223344556677\n";
  input.request.companions["dbc"] = {{"fuzz.dbc", dbc}};
  try {
    read_signals(dbc);
  } catch (const waymark::InputError&) {
    // The reader meets the same one below.
  }
  const waymark::LogReader& reader = *waymark::formats::builtin_log_reader("candump");
  const Outcome whole = read_log(reader, log, input.request, 0);
  if (!whole.refused) check_data(whole.data, input.request);
  check_same(whole, read_log(reader, log, input.request, input.piece));
}

}  // namespace waymark_fuzz
