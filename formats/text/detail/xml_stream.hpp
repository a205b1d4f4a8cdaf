/// XML in pieces, by expat, with bounds on what a hostile document can make it hold.
#pragma once

#include <cstddef>
#include <exception>
#include <memory>
#include <set>
#include <string>
#include <string_view>

struct XML_ParserStruct;

namespace waymark::formats {

/// Reads a document and calls its derived class for elements and text. Namespace prefixes are cut off.
class XmlStream {
 public:
  XmlStream();
  XmlStream(const XmlStream&) = delete;
  XmlStream& operator=(const XmlStream&) = delete;
  virtual ~XmlStream();

  /// The next bytes. After trouble() they are passed over.
  void take(std::string_view piece);
  /// After the last bytes.
  void finish();

  /// What ended the reading before the document's end, and where; empty: nothing.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] std::size_t trouble_line() const { return trouble_line_; }
  [[nodiscard]] std::size_t trouble_column() const { return trouble_column_; }

 protected:
  /// An element begins. @param attributes  name, value, name, value, ..., null
  virtual void begin(std::string_view name, const char** attributes) = 0;
  virtual void end(std::string_view name) = 0;
  /// A part of the text of the innermost element.
  virtual void text(std::string_view part) = 0;
  /// Of the element whose begin or end is being told: 1 is the root.
  [[nodiscard]] std::size_t depth() const { return depth_; }
  /// 1-based place of what is being told.
  [[nodiscard]] std::size_t line() const;
  [[nodiscard]] std::size_t column() const;
  /// Counts a name that the derived class does not know. The parser remembers every different name.
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
  std::string held_;  ///< small pieces, until they are worth a call
  std::size_t given_ = 0;
  std::size_t depth_ = 0;
  std::set<std::string, std::less<>> unknown_;
  std::exception_ptr thrown_;  ///< by a derived class; it must not pass through C
  std::string trouble_;
  std::size_t trouble_line_ = 0;
  std::size_t trouble_column_ = 0;
};

}  // namespace waymark::formats
