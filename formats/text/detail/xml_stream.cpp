#include <waymark/formats/text/detail/xml_stream.hpp>

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

#include <expat.h>
#include <fmt/format.h>

namespace waymark::formats {
namespace {

constexpr std::size_t kXmlPiece = 64U << 10U;
/// Expat holds a token until it is complete, and scans it again with every piece.
constexpr std::size_t kLongestToken = 1U << 20U;
constexpr std::size_t kDeepest = 64;
constexpr std::size_t kMostUnknown = 1000;

std::string_view without_prefix(const char* name) {
  const char* const colon = std::strchr(name, ':');
  return colon == nullptr ? name : colon + 1;
}

}  // namespace

void XmlStream::FreeParser::operator()(XML_ParserStruct* parser) const {
  XML_ParserFree(parser);
}

/// The callbacks of expat. Exceptions stop here and are thrown again by parse().
struct XmlStream::Handlers {
  template <class Call>
  static void guarded(void* stream, Call call) {
    auto& self = *static_cast<XmlStream*>(stream);
    if (self.thrown_ || !self.trouble_.empty()) return;
    try {
      call(self);
    } catch (...) {
      self.thrown_ = std::current_exception();
      XML_StopParser(self.parser_.get(), XML_FALSE);
    }
  }
  static void begin(void* stream, const char* name, const char** attributes) {
    guarded(stream, [&](XmlStream& self) {
      if (++self.depth_ > kDeepest) {
        self.stop("elements are nested more than 64 deep");
        return;
      }
      self.begin(without_prefix(name), attributes);
    });
  }
  static void end(void* stream, const char* name) {
    guarded(stream, [&](XmlStream& self) {
      self.end(without_prefix(name));
      --self.depth_;
    });
  }
  static void text(void* stream, const char* part, int length) {
    guarded(stream, [&](XmlStream& self) { self.text({part, static_cast<std::size_t>(length)}); });
  }
  static void doctype(void* stream, const char*, const char*, const char*, int) {
    guarded(stream, [](XmlStream& self) {
      self.stop("a document type declaration, which could define endless text");
    });
  }
};

XmlStream::XmlStream() : parser_(XML_ParserCreate(nullptr)) {
  if (!parser_) throw std::bad_alloc();
  XML_SetUserData(parser_.get(), this);
  XML_SetElementHandler(parser_.get(), Handlers::begin, Handlers::end);
  XML_SetCharacterDataHandler(parser_.get(), Handlers::text);
  XML_SetStartDoctypeDeclHandler(parser_.get(), Handlers::doctype);
}

XmlStream::~XmlStream() = default;

void XmlStream::take(std::string_view piece) {
  if (held_.size() + piece.size() < kXmlPiece) {
    if (trouble_.empty()) held_ += piece;
    return;
  }
  parse(held_, false);
  held_.clear();
  for (; !piece.empty(); piece.remove_prefix(std::min(kXmlPiece, piece.size())))
    parse(piece.substr(0, kXmlPiece), false);
}

void XmlStream::finish() {
  parse(held_, true);
  held_.clear();
}

void XmlStream::parse(std::string_view bytes, bool last) {
  if (!trouble_.empty() || (bytes.empty() && !last)) return;
  given_ += bytes.size();
  const XML_Status status =
      XML_Parse(parser_.get(), bytes.data(), static_cast<int>(bytes.size()), last ? XML_TRUE : XML_FALSE);
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  if (!trouble_.empty()) return;
  if (status != XML_STATUS_OK) {
    set_trouble(
        fmt::format("the XML is not well-formed: {}", XML_ErrorString(XML_GetErrorCode(parser_.get()))));
    return;
  }
  const auto reached =
      static_cast<std::size_t>(std::max<XML_Index>(0, XML_GetCurrentByteIndex(parser_.get())));
  if (given_ - std::min(reached, given_) > kLongestToken) set_trouble("a tag of more than 1 MiB");
}

void XmlStream::stop(const char* trouble) {
  set_trouble(trouble);
  XML_StopParser(parser_.get(), XML_FALSE);
}

void XmlStream::set_trouble(const std::string& trouble) {
  trouble_ = trouble;
  trouble_line_ = line();
  trouble_column_ = column();
}

std::size_t XmlStream::line() const {
  return XML_GetCurrentLineNumber(parser_.get());
}

std::size_t XmlStream::column() const {
  return XML_GetCurrentColumnNumber(parser_.get()) + 1;
}

void XmlStream::count_unknown(std::string_view name) {
  if (unknown_.find(name) != unknown_.end()) return;
  unknown_.emplace(name);
  if (unknown_.size() > kMostUnknown) stop("more than 1000 different names that GPX does not have");
}

}  // namespace waymark::formats
