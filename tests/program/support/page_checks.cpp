#include "program/support/page_checks.hpp"

#include <regex>
#include <set>

namespace {

std::vector<std::string> all_matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
    found.push_back((*it)[1].str());
  return found;
}

/// The part between two marks, the first one's next occurrence after `from`.
std::string between(const std::string& text, const std::string& begin, const std::string& end,
                    std::size_t from = 0) {
  const std::size_t at = text.find(begin, from);
  if (at == std::string::npos) return "";
  return text.substr(at, text.find(end, at) - at);
}

std::string table(const std::string& html, const std::string& caption) {
  return between(html, "<caption>" + caption + "</caption>", "</table>");
}

/// The page without script and style: those are code, not content.
std::string content_of(const std::string& html) {
  const std::size_t begin = html.find("<body>");
  return html.substr(begin, html.find("<script>", begin) - begin);
}

}  // namespace

std::vector<std::string> page_flaws(const std::string& html) {
  std::vector<std::string> flaws;
  for (const std::string& address : all_matches(html, std::regex("(https?:[^\"' ]*)")))
    // The second is opened by a click only.
    if (!address.starts_with("http://www.w3.org/") && !address.starts_with("https://www.openstreetmap.org/"))
      flaws.push_back("refers to " + address);
  const std::string content = content_of(html);
  std::set<std::string> ids;
  for (const std::string& id : all_matches(content, std::regex(" id=\"([^\"]*)\"")))
    if (!ids.insert(id).second) flaws.push_back("twice: id " + id);
  for (const std::string& target : all_matches(content, std::regex("href=\"#([^\"]*)\"")))
    if (!ids.contains(target)) flaws.push_back("link to nothing: " + target);
  for (std::size_t at = content.find("<figure "); at != std::string::npos;
       at = content.find("<figure ", at + 1)) {
    const std::string figure = between(content, "<figure ", "</figure>", at);
    for (const char* part : {"<title id=", "<desc id=", "<figcaption>", "role=\"img\""})
      if (figure.find(part) == std::string::npos)
        flaws.push_back(std::string("no ") + part + " in " + figure.substr(0, 60));
    for (const char* empty : {"\"></title>", "\"></desc>"})
      if (figure.find(empty) != std::string::npos) flaws.push_back("empty title in " + figure.substr(0, 60));
  }
  for (const char* number : {">nan<", ">-nan<", ">inf<", ">-inf<", "\"nan", " nan"})
    if (content.find(number) != std::string::npos) flaws.push_back(std::string("has ") + number);
  return flaws;
}

std::vector<std::string> table_row(const std::string& html, const std::string& caption,
                                   const std::string& first) {
  const std::string of = table(html, caption);
  const std::string text = between(of, "<tr><td>" + first + "</td>", "</tr>");
  return all_matches(text, std::regex("<td[^>]*>([^<]*)</td>"));
}

std::vector<std::string> table_columns(const std::string& html, const std::string& caption) {
  const std::string plain = std::regex_replace(table(html, caption), std::regex("</?abbr[^>]*>"), "");
  return all_matches(plain, std::regex("<th[^>]*>([^<]*)</th>|<td class=\"corner\"></td>"));
}
