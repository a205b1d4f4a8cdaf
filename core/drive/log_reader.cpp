#include <waymark/core/drive/log_reader.hpp>

#include <waymark/core/base/error.hpp>

namespace waymark {
namespace {

/// Collects the text for a reader that needs all of it.
class WholeLogDecoder final : public LogDecoder {
 public:
  WholeLogDecoder(const WholeLogReader& reader, std::string path, LogRequest request)
      : reader_(reader), path_(std::move(path)), request_(std::move(request)) {}
  void take(std::string_view piece) override { text_ += piece; }
  void finish() override { data_ = reader_.read_whole(text_, path_, request_); }

 private:
  const WholeLogReader& reader_;
  std::string path_;
  LogRequest request_;
  std::string text_;
};

}  // namespace

LogData LogReader::read(std::string_view text, const std::string& path, const LogRequest& request) const {
  const std::unique_ptr<LogDecoder> decoder = open(path, request);
  decoder->take(text);
  decoder->finish();
  require_samples(decoder->data(), path);
  return std::move(decoder->data());
}

std::unique_ptr<LogDecoder> WholeLogReader::open(const std::string& path, const LogRequest& request) const {
  return std::make_unique<WholeLogDecoder>(*this, path, request);
}

void add_corrupt(LogData& data, const std::string& path, std::size_t line, std::size_t column,
                 const std::string& what) {
  ++data.corrupt;
  if (data.corrupt_examples.size() >= kCorruptExamples) return;
  std::string place = path;
  place += ':' + std::to_string(line);
  place += ':' + std::to_string(column);
  data.corrupt_examples.push_back(place + ": " + what);
}

void require_samples(const LogData& data, const std::string& path) {
  if (data.odometry.size() + data.fixes.size() + data.truth.size() + data.readings.size() > 0) return;
  if (data.records == 0) throw EmptyLogError(path + ": the log holds no records");
  const std::string records = std::to_string(data.records) + " records";
  if (data.corrupt > 0)
    throw InputError(path + ": none of " + records +
                     " could be used; first: " + data.corrupt_examples.front());
  throw EmptyLogError(path + ": not one fix in " + records + " (" + std::to_string(data.without_fix) +
                   " are marked as without a fix)");
}

}  // namespace waymark
