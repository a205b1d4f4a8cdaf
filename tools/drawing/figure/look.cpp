#include <array>

#include <waymark/tools/drawing/figure/look.hpp>

namespace waymark::drawing {
namespace {

constexpr std::string_view kCircle = "m-2.5 0a2.5 2.5 0 1 0 5 0a2.5 2.5 0 1 0-5 0";
constexpr std::string_view kSquare = "m-2.2-2.2h4.4v4.4h-4.4z";
constexpr std::string_view kDiamond = "m0-3.4l3 3.4l-3 3.4l-3-3.4z";
constexpr std::string_view kCross = "m-3-3l6 6m0-6l-6 6";
constexpr std::string_view kTriangle = "m0-3.4l3.2 5.8h-6.4z";
constexpr std::string_view kPlus = "m-3.4 0h6.8m-3.4-3.4v6.8";
constexpr std::string_view kTriangleDown = "m0 3.4l3.2-5.8h-6.4z";
constexpr std::string_view kHourglass = "m-2.8-2.8h5.6l-5.6 5.6h5.6z";
constexpr std::string_view kRight = "m3.4 0l-5.8 3.2v-6.4z";
constexpr std::string_view kLeft = "m-3.4 0l5.8 3.2v-6.4z";
constexpr std::string_view kUp = "m0-3.2v6.4";
constexpr std::string_view kBox = "m-3-2h6v4h-6z";

// Okabe and Ito, Color Universal Design, 2008. Their yellow is left out, because it is
// invisible on white.
constexpr std::array kLooks = {
    LookStyle{Look::raw, "raw", "#d55e00", "2 3", kCircle, ""},
    LookStyle{Look::fused, "fused", "#0072b2", "", kSquare, "M0 6l6-6"},
    LookStyle{Look::truth, "truth", "#222222", "9 3", kDiamond, "M0 1h6M0 4h6"},
    LookStyle{Look::rejected, "rejected", "#a0307a", "1 2", kCross, "M0 6l6-6M0 0l6 6"},
    LookStyle{Look::withheld, "withheld", "#56b4e9", "6 2 1 2", kTriangle, "M1 0v6M4 0v6"},
    LookStyle{Look::reference, "reference", "#777777", "5 4", kPlus, "M2 2h1"},
    LookStyle{Look::first, "first", "#009e73", "12 3 2 3", kTriangleDown, "M0 0l6 6"},
    LookStyle{Look::second, "second", "#cc79a7", "4 2", kHourglass, "M0 3h6"},
    LookStyle{Look::third, "third", "#e69f00", "8 2 2 2 2 2", kRight, "M3 0v6"},
    LookStyle{Look::fourth, "fourth", "#5b4a9e", "3 1", kLeft, "M0 3h6M3 0v6"},
    // A map lies beneath: its lines are solid, wider and paler than those of any result (figure.css).
    LookStyle{Look::road, "road", "#c3c3cb", "none", kUp, "M0 2h6"},
    LookStyle{Look::building, "building", "#e7dfd3", "2 0", kBox, "M0 5h6"}};

constexpr std::array kOfSystems = {Look::fused,  Look::first,    Look::second,  Look::third,
                                   Look::fourth, Look::withheld, Look::rejected};

}  // namespace

std::span<const LookStyle> all_looks() {
  return kLooks;
}

const LookStyle& style_of(Look look) {
  return kLooks[static_cast<std::size_t>(look)];
}

Look look_of_system(std::size_t index) {
  return kOfSystems[index % kOfSystems.size()];
}

}  // namespace waymark::drawing
