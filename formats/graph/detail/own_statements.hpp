/// The statements that only .graph files have: header, stamps, losses, records, covariances.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/formats/text/detail/line_scanner.hpp>

namespace waymark::formats {

class OwnStatements {
 public:
  /// Both arguments must outlive this object.
  OwnStatements(GraphDocument& document, const TypeRegistry& registry)
      : document_(document), registry_(registry) {}

  /// Reads the rest of a line that begins with `tag` into the document. The vertices must be in the
  /// document already.
  /// @param edge_above the batch whose last edge is directly above the line; null if there is none
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
  void read_source(LineScanner& line);
  void read_states(LineScanner& line);
  void read_edges(LineScanner& line);
  /// Returns the source that the next word names. @throws InputError if it is not above this line
  [[nodiscard]] DocumentSource& source_above(LineScanner& line, const std::string& statement);
  void check_type(LineScanner& line) const;
  /// Refuses a second line of a statement that holds for the whole file.
  void only_once(LineScanner& line, const std::string& statement);

  GraphDocument& document_;
  const TypeRegistry& registry_;
  std::vector<std::string> seen_;
  std::vector<char> has_covariance_;  // per vertex
};

}  // namespace waymark::formats
