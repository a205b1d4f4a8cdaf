/// The statements that only a .graph file has: its header, stamps, losses, records, covariances.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {

class OwnStatements {
 public:
  /// Both must live as long as this.
  OwnStatements(GraphDocument& document, const TypeRegistry& registry)
      : document_(document), registry_(registry) {}

  /// The rest of a line that begins with `tag`, into the document. The vertices must be there already.
  /// @param edge_above  the batch whose last edge stands above the line; null: none does
  /// @return whether the tag is one of these statements
  /// @throws InputError
  [[nodiscard]] bool read(LineScanner& line, std::string_view tag, EdgeBatchBase* edge_above);

 private:
  [[nodiscard]] bool read_header(LineScanner& line, std::string_view tag);
  void read_stamp(LineScanner& line);
  void read_loss(LineScanner& line, EdgeBatchBase* edge_above);
  void read_record(LineScanner& line);
  void read_covariance(LineScanner& line);
  void read_time(LineScanner& line);
  void read_lever(LineScanner& line);
  void check_type(LineScanner& line) const;
  /// For statements that hold for the whole file.
  void only_once(LineScanner& line, const std::string& statement);

  GraphDocument& document_;
  const TypeRegistry& registry_;
  std::vector<std::string> seen_;
  std::vector<char> has_covariance_;  // per vertex
};

}  // namespace waymark::formats
