// One log reader (WAYMARK_FUZZ_READER): any bytes, in pieces of any length, under any request it can meet.
#include <waymark/formats/logs/log_readers.hpp>

#include "fuzz_input.hpp"
#include "invariants.hpp"

using namespace waymark_fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const waymark::LogReader& reader = *waymark::formats::builtin_log_reader(WAYMARK_FUZZ_READER);
  const FuzzInput input = fuzz_input(WAYMARK_FUZZ_READER, bytes, size);
  const Outcome whole = read_log(reader, input.log, input.request, 0);
  if (!whole.refused) check_data(whole.data, input.request);
  check_same(whole, read_log(reader, input.log, input.request, input.piece));
  check_recognition(input.log);
  return 0;
}
