#include <array>
#include <iterator>

#include <fmt/format.h>

#include <waymark/core/drive/sample.hpp>
#include <waymark/formats/trajectory/map_formats.hpp>

namespace waymark::formats {
namespace {

/// The appearance of the fixes of a status; colours are those of the KML.
struct FixMarker {
  FixStatus status;
  std::string_view color;  ///< red, green, blue, alpha
  std::string_view shape;
};
constexpr std::array<FixMarker, 3> kFixMarkers = {{{FixStatus::accepted, "77,179,77,255", "circle"},
                                                   {FixStatus::rejected, "214,39,40,255", "cross2"},
                                                   {FixStatus::withheld, "31,119,180,255", "square"}}};

}  // namespace

// A GeoJSON with lines and points becomes two layers in QGIS, and both load the same style. Rules serve
// both, and no geometry type is stated, because QGIS refuses a style with another type than the layer's.
std::string trajectory_qml() {
  std::string rules =
      R"(   <rule key="fused" label="fused trajectory" filter="&quot;kind&quot; = 'fused'" symbol="0"/>
)";
  std::string symbols = R"(   <symbol name="0" type="line" alpha="1">
    <layer class="SimpleLine" enabled="1" pass="0">
     <prop k="line_color" v="44,160,44,255"/><prop k="line_width" v="0.8"/><prop k="line_width_unit" v="MM"/>
    </layer>
   </symbol>
)";
  int number = 0;
  for (const FixMarker& marker : kFixMarkers) {
    const std::string_view status = to_string(marker.status);
    fmt::format_to(std::back_inserter(rules),
                   R"(   <rule key="{0}" label="{0} fixes" filter="&quot;status&quot; = '{0}'" symbol="{1}"/>
)",
                   status, ++number);
    fmt::format_to(std::back_inserter(symbols), R"(   <symbol name="{}" type="marker" alpha="1">
    <layer class="SimpleMarker" enabled="1" pass="0">
     <prop k="name" v="{}"/><prop k="color" v="{}"/><prop k="outline_color" v="{}"/>
     <prop k="size" v="1.6"/><prop k="size_unit" v="MM"/>
    </layer>
   </symbol>
)",
                   number, marker.shape, marker.color, marker.color);
  }
  return fmt::format(R"(<qgis version="3.22.16" styleCategories="Symbology">
 <renderer-v2 type="RuleRenderer" symbollevels="0" forceraster="0" enableorderby="0">
  <rules key="waymark">
{}  </rules>
  <symbols>
{}  </symbols>
 </renderer-v2>
</qgis>
)",
                     rules, symbols);
}

}  // namespace waymark::formats
