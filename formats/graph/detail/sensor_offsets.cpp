#include <waymark/formats/graph/detail/sensor_offsets.hpp>

#include <algorithm>

namespace waymark::formats {
namespace {

/// How many numbers an edge measures, and how many offsets follow them.
struct Layout {
  std::size_t measured = 0;
  std::size_t offsets = 0;
};

Layout layout_of(std::string_view tag) {
  return tag == "EDGE_SE2_OFFSET" ? Layout{3, 2} : Layout{2, 1};
}

SensorOffsets::Offset offset_of(const std::vector<double>& fields, const Layout& layout, std::size_t k) {
  SensorOffsets::Offset offset{};
  const auto begin = fields.begin() + static_cast<std::ptrdiff_t>(layout.measured + 3 * k);
  std::copy_n(begin, 3, offset.begin());
  return offset;
}

}  // namespace

bool has_offsets(std::string_view tag) {
  return tag == "EDGE_SE2_OFFSET" || tag == "EDGE_SE2_POINTXY_OFFSET";
}

void SensorOffsets::read(LineScanner& line) {
  const std::int64_t id = line.integer({kOffsetTag, "id"});
  if (by_id_.contains(id)) {
    line.fail(std::string(kOffsetTag) + ": offset " + std::to_string(id) + " is defined a second time");
  }
  Offset offset{};
  offset[0] = line.number({kOffsetTag, "x"});
  offset[1] = line.number({kOffsetTag, "y"});
  offset[2] = line.number({kOffsetTag, "heading"});
  line.end(kOffsetTag);
  by_id_[id] = offset;
}

void SensorOffsets::read_fields(LineScanner& line, const EdgeType& type, std::vector<double>& values) const {
  std::vector<double> offsets;
  for (std::size_t k = 1; k < type.fields.size(); ++k) {
    const std::int64_t id = line.integer({type.tag, type.fields[k].name});
    const auto found = by_id_.find(id);
    if (found == by_id_.end()) {
      line.fail(type.tag + ": " + std::string(kOffsetTag) + " " + std::to_string(id) + " is not defined");
    }
    offsets.insert(offsets.end(), found->second.begin(), found->second.end());
  }
  const FieldInfo& measured = type.fields.front();
  for (int i = 0; i < measured.size; ++i) values.push_back(line.number({type.tag, measured.name, i}));
  values.insert(values.end(), offsets.begin(), offsets.end());
}

void SensorOffsets::collect(std::string_view tag, const std::vector<double>& fields) {
  const Layout layout = layout_of(tag);
  for (std::size_t k = 0; k < layout.offsets; ++k) {
    const Offset offset = offset_of(fields, layout, k);
    const auto next = static_cast<std::int64_t>(ids_.size());
    if (ids_.emplace(offset, next).second) by_id_[next] = offset;
  }
}

void SensorOffsets::write(TextBuilder& out) const {
  for (const auto& [id, offset] : by_id_) {
    out.word(kOffsetTag).integer(id);
    for (const double value : offset) out.number(value);
    out.end_line();
  }
}

void SensorOffsets::write_fields(std::string_view tag, const std::vector<double>& fields,
                                 TextBuilder& out) const {
  const Layout layout = layout_of(tag);
  for (std::size_t k = 0; k < layout.offsets; ++k) out.integer(ids_.at(offset_of(fields, layout, k)));
  for (std::size_t i = 0; i < layout.measured; ++i) out.number(fields[i]);
}

}  // namespace waymark::formats
