/// Examines XML texts with expat, as an independent check.
#pragma once

#include <expat.h>
#include <string>
#include <string_view>
#include <vector>

/// Returns the first XML error; empty if the text is well-formed.
inline std::string xml_error(const std::string& text) {
  XML_Parser parser = XML_ParserCreate(nullptr);
  std::string error;
  if (XML_Parse(parser, text.data(), static_cast<int>(text.size()), 1) != XML_STATUS_OK) {
    error = XML_ErrorString(XML_GetErrorCode(parser));
    error += " in line ";
    error += std::to_string(XML_GetCurrentLineNumber(parser));
  }
  XML_ParserFree(parser);
  return error;
}

/// Returns an attribute of every element with a name.
inline std::vector<std::string> xml_attributes(const std::string& text, const std::string& element,
                                               const std::string& attribute) {
  struct Search {
    const std::string& element;
    const std::string& attribute;
    std::vector<std::string> found;
  } search{element, attribute, {}};
  XML_Parser parser = XML_ParserCreate(nullptr);
  XML_SetUserData(parser, &search);
  XML_SetStartElementHandler(parser, [](void* user, const XML_Char* name, const XML_Char** attributes) {
    auto& wanted = *static_cast<Search*>(user);
    if (wanted.element != name) return;
    for (; *attributes != nullptr; attributes += 2) {
      if (wanted.attribute == attributes[0]) wanted.found.emplace_back(attributes[1]);
    }
  });
  (void)XML_Parse(parser, text.data(), static_cast<int>(text.size()), 1);
  XML_ParserFree(parser);
  return search.found;
}
