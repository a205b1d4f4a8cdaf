// One log reader: any bytes, in pieces of any length, under any request it can meet.
#include <waymark/formats/logs/log_readers.hpp>

#include "fuzz_input.hpp"
#include "invariants.hpp"

#include "targets.hpp"

namespace waymark_fuzz {

void fuzz_log_reader(std::string_view name, const std::uint8_t* bytes, std::size_t size) {
  const waymark::LogReader& reader = *waymark::formats::builtin_log_reader(name);
  const FuzzInput input = fuzz_input(name, bytes, size);
  const Outcome whole = read_log(reader, input.log, input.request, 0);
  if (!whole.refused) check_data(whole.data, input.request);
  check_same(whole, read_log(reader, input.log, input.request, input.piece));
  check_recognition(input.log);
}

}  // namespace waymark_fuzz
