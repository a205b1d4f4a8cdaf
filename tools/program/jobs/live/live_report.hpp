/// The page at the end of a live run: what happened on the way, and how long the work took.
#pragma once

#include <string>

#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/live/session/session.hpp>

namespace waymark::program {

/// Returns its end in a sentence, the way, the radius of 95 %, the histogram of latencies, and what was used
/// and refused. @param name of the drive
[[nodiscard]] drawing::Page live_page(const live::Session& session, const std::string& name);

}  // namespace waymark::program
