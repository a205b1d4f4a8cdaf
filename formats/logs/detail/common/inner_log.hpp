/// Logs that stand inside another log: a table in a container, sentences between binary frames.
#pragma once

#include <algorithm>
#include <iterator>
#include <utility>

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Adds the records, complaints and notes of an inner log. Its samples are not touched.
inline void add_counts(LogData& data, LogData& inner) {
  data.records += inner.records;
  data.without_fix += inner.without_fix;
  data.corrupt += inner.corrupt;
  std::move(inner.corrupt_examples.begin(), inner.corrupt_examples.end(),
            std::back_inserter(data.corrupt_examples));
  data.corrupt_examples.resize(std::min(data.corrupt_examples.size(), kCorruptExamples));
  std::move(inner.notes.begin(), inner.notes.end(), std::back_inserter(data.notes));
}

}  // namespace waymark::formats
