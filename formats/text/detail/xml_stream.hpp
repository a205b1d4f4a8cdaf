/// Parses XML in pieces with expat, and limits the memory that a hostile document can take.
#pragma once

#include <cstddef>
#include <exception>
#include <memory>
#include <set>
#include <string>
#include <string_view>

struct XML_ParserStruct;

namespace waymark::formats {

/// Reads a document and calls the derived class for elements and text. Namespace prefixes
/// are cut off.
class XmlStream {
 public:
  XmlStream();
  XmlStream(const XmlStream&) = delete;
  XmlStream& operator=(const XmlStream&) = delete;
  virtual ~XmlStream();

  /// Takes the next bytes. After trouble() they are ignored.
  void take(std::string_view piece);
  /// Call this after the last bytes.
  void finish();

  /// Returns the error that stopped the parser, and its place. Empty if there is none.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] std::size_t trouble_line() const { return trouble_line_; }
  [[nodiscard]] std::size_t trouble_column() const { return trouble_column_; }

 protected:
  /// Called at the beginning of an element. @param attributes name, value, name, value, ..., null
  virtual void begin(std::string_view name, const char** attributes) = 0;
  virtual void end(std::string_view name) = 0;
  /// Called with a part of the text of the innermost element.
  virtual void text(std::string_view part) = 0;
  /// Returns the depth of the current element; the root has 1.
  [[nodiscard]] std::size_t depth() const { return depth_; }
  /// Returns the 1-based line of the current event.
  [[nodiscard]] std::size_t line() const;
  [[nodiscard]] std::size_t column() const;
  /// Counts a name that the derived class does not know, because the parser remembers every
  /// different name.
  void count_unknown(std::string_view name);

 private:
  struct Handlers;
  void parse(std::string_view bytes, bool last);
  void stop(const char* trouble);
  void set_trouble(const std::string& trouble);

  struct FreeParser {
    void operator()(XML_ParserStruct* parser) const;
  };
  std::unique_ptr<XML_ParserStruct, FreeParser> parser_;
  std::string held_;  ///< collects small pieces until a call is worth while
  std::size_t given_ = 0;
  std::size_t depth_ = 0;
  std::set<std::string, std::less<>> unknown_;
  std::exception_ptr thrown_;  ///< from a derived class; it must not pass through C code
  std::string trouble_;
  std::size_t trouble_line_ = 0;
  std::size_t trouble_column_ = 0;
};

}  // namespace waymark::formats
