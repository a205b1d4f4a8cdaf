#include <random>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/guard.hpp>
#include <waymark/tools/program/jobs/conformance/trials.hpp>

namespace waymark::program {
namespace {

/// Texts that no reader may trip over.
std::vector<std::string> rubbish() {
  std::vector<std::string> texts = {"",
                                    "\n\n\n",
                                    "time,speed\n1,2\n",
                                    std::string(3, '\0'),
                                    "1 2 3 4 5 6 7 8 9\n",
                                    "nan inf -1e999\n",
                                    std::string(70'000, 'x')};
  std::mt19937_64 random(9);
  std::string bytes;
  for (int i = 0; i < 20'000; ++i) bytes += static_cast<char>(random() & 0xff);
  texts.push_back(bytes);
  return texts;
}

/// Returns what a reader makes of a text in pieces of a size, or its error.
std::string outcome(const LogReader& reader, const std::string& text, std::size_t piece) {
  LogRequest request;
  request.default_sigma_m = 1;
  try {
    const auto decoder = reader.open("trial.log", request);
    for (std::size_t at = 0; at < text.size(); at += piece)
      decoder->take(std::string_view(text).substr(at, piece));
    decoder->finish();
    const LogData& data = decoder->data();
    return std::to_string(data.fixes.size()) + " fixes, " + std::to_string(data.records) + " records, " +
           std::to_string(data.corrupt) + " corrupt";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

std::vector<Trial> try_readers(const TypeRegistry& registry, const Wanted& wanted) {
  std::vector<Trial> trials;
  for (const auto& entry : registry.log_readers()) {
    if (!wanted(entry.origin)) continue;
    run_trial(trials.emplace_back(Trial{"log reader", entry.type.name, entry.origin, {}, {}}),
              [&](Trial& trial) {
                for (const std::string& text : rubbish()) {
                  const std::string whole =
                      outcome(*entry.type.reader, text, std::max<std::size_t>(text.size(), 1));
                  for (const std::size_t piece : {std::size_t{1}, std::size_t{777}})
                    if (outcome(*entry.type.reader, text, piece) != whole)
                      trial.problems.push_back("depends on the size of the pieces: whole '" + whole +
                                               "', in pieces of " + std::to_string(piece) + " '" +
                                               outcome(*entry.type.reader, text, piece) + "'");
                  const Recognition why = entry.type.reader->recognise(text);
                  if (!(why.certainty >= 0 && why.certainty <= 1))
                    trial.problems.emplace_back("recognise: the certainty is not in 0 .. 1");
                }
              });
  }
  return trials;
}

}  // namespace waymark::program
