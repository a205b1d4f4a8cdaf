/// The map that a user puts beneath the trajectory: --map FILE.geojson.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/frame.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/formats/map/geojson_map.hpp>
#include <waymark/tools/drawing/figure/figure.hpp>

namespace waymark::program {

/// The ways of a map file that may be near a drive, in its frame.
struct MapFile {
  std::string name{};                   ///< empty: no map
  std::vector<formats::MapWay> ways{};  ///< grid metres
};

/// Reads a map and keeps what is less than 2 km outside the rectangle of some positions. It is called
/// before the work of a command, so that a wrong file costs no time.
/// @param file empty: no map
/// @param positions of the drive, m
/// @throws InputError for a file that is no map, one without ways near the positions, and a frame
/// without a place on Earth
[[nodiscard]] MapFile read_map_file(const std::string& file, const Frame& frame,
                                    const std::vector<Eigen::Vector2d>& positions);

/// Returns the positions of fixes.
[[nodiscard]] std::vector<Eigen::Vector2d> positions_of(const std::vector<Fix>& fixes);
/// Returns the positions of the fixes of a document; without fixes those of its poses.
[[nodiscard]] std::vector<Eigen::Vector2d> positions_of(const formats::GraphDocument& document);

/// Returns the ways near the fused trajectory of a document, as series of its figure.
[[nodiscard]] std::vector<drawing::Series> ground_of(const MapFile& map,
                                                     const formats::GraphDocument& document);

}  // namespace waymark::program
