# The public headers by room: what a program or a plugin may include, and what a version promises to keep. Everything else
# lies under detail/ or belongs to the program. `cmake --install` installs these two lists and nothing else;
# tests/consumer checks that the second is exactly what the first must include.
set(WAYMARK_PUBLIC_HEADERS
  core/base/angle.hpp
  core/base/error.hpp
  core/base/export.hpp
  core/base/suggest.hpp
  core/covariance/evidence.hpp
  core/covariance/marginals.hpp
  core/drive/frame.hpp
  core/drive/log_reader.hpp
  core/drive/modeling.hpp
  core/drive/sample.hpp
  core/drive/stamp.hpp
  core/graph/dual.hpp
  core/graph/edge.hpp
  core/graph/edge_batch.hpp
  core/graph/edge_type_check.hpp
  core/graph/fields.hpp
  core/graph/gaussian_prior.hpp
  core/graph/gradient_check.hpp
  core/graph/graph.hpp
  core/graph/loss.hpp
  core/graph/scalar_state.hpp
  core/graph/vertex.hpp
  core/linear/block_cholesky.hpp
  core/linear/block_pattern.hpp
  core/linear/block_symbolic.hpp
  core/linear/dense_decompositions.hpp
  core/linear/linear_solver.hpp
  core/optimize/algorithm.hpp
  core/optimize/multi_start.hpp
  core/optimize/optimizer.hpp
  core/optimize/start.hpp
  core/optimize/summary.hpp
  core/registry/options.hpp
  core/registry/plugin.hpp
  core/registry/plugin_loader.hpp
  core/registry/registry.hpp
  core/robust/chi_square.hpp
  core/robust/edge_selection.hpp
  core/robust/graduation.hpp
  core/system/gauge.hpp
  core/system/normal_equations.hpp
  core/system/structure.hpp
  core/system/structured_solver.hpp
  core/window/incremental.hpp
  core/window/marginalization.hpp

  types_se2/edge_gnss.hpp
  types_se2/edge_se2.hpp
  types_se2/g2o_edges.hpp
  types_se2/plugin_kit/gnss_modeling.hpp
  types_se2/plugin_kit/sensor_readings.hpp
  types_se2/register.hpp
  types_se2/se2.hpp
  types_se2/stamped_pose.hpp
  types_se2/vertex_se2.hpp

  solvers/optimize.hpp
  solvers/register.hpp

  formats/graph/graph_document.hpp
  formats/graph/graph_format.hpp
  formats/logs/channels.hpp
  formats/logs/log_file.hpp
  formats/logs/log_readers.hpp
  formats/text/iso8601.hpp
  formats/text/stamp_text.hpp
  formats/text/text_file.hpp
  formats/text/text_sink.hpp
  formats/trajectory/map_formats.hpp
  formats/trajectory/trajectory.hpp

  plugins/builtin.hpp
  plugins/gnss_correlated/gnss_bias.hpp
  plugins/gnss_velocity/gnss_velocity.hpp
  plugins/heading/heading.hpp
  plugins/landmarks/landmarks.hpp
  plugins/lane/lane.hpp
  plugins/odometry/calibration.hpp
  plugins/odometry/edge_odometry.hpp

  tools/drive/description/drive_description.hpp
  tools/drive/description/drive_file.hpp
  tools/drive/description/fusion_settings.hpp
  tools/drive/logs/odometry_parts.hpp
  tools/drive/logs/prepare.hpp
  tools/drive/model/fuse.hpp
  tools/drive/model/minimize.hpp
  tools/drive/model/noise.hpp
  tools/drive/model/place.hpp
  tools/drive/model/poses_at_fixes.hpp
  tools/drive/nodes/gate.hpp
  tools/drive/nodes/start.hpp
  tools/drive/nodes/timeline.hpp)

# Included by public headers, mostly by their templates. No promise: a program does not include them itself.
set(WAYMARK_INCLUDED_HEADERS
  core/base/detail/large_array.hpp
  core/base/detail/processor.hpp
  core/base/detail/thread_pool.hpp
  core/base/detail/unrolled.hpp
  core/graph/detail/robust_information.hpp
  core/graph/detail/typed_batch.hpp
  core/linear/detail/dense_kernels.hpp
  types_se2/detail/sin_cos.hpp)
