/// Style sheets and script of the pages: the files of page/. CMake puts them into the library.
#pragma once

#include <string_view>

namespace waymark::drawing {

extern const std::string_view kFigureStyle;
extern const std::string_view kPageStyle;
extern const std::string_view kPageScript;

}  // namespace waymark::drawing
