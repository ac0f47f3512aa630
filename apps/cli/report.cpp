#include "report.h"

#include "arguments.h"
#include "option_names.h"

namespace meshgrain::cli {
namespace {

Json energies(const std::vector<EnergyRecord>& records) {
  Json list = Json::array();
  for (const EnergyRecord& r : records) {
    list.push_back({{"level", r.level}, {"sweep", r.sweep}, {"energy", r.energy}});
  }
  return list;
}

Json number_or_null(const std::optional<std::size_t>& number) {
  return number ? Json(*number) : Json(nullptr);
}

}  // namespace

std::string faces_by_kind(const MeshStatistics& s) {
  std::string text;
  const auto add = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) text += (text.empty() ? "" : ", ") + counted(count, one, many);
  };
  add(s.quads, "quad", "quads");
  add(s.triangles, "triangle", "triangles");
  add(s.larger, "larger", "larger");
  return text;
}

Json to_json(const MeshStatistics& s) {
  return {{"vertices", s.vertices},
          {"faces", s.faces},
          {"triangles", s.triangles},
          {"quads", s.quads},
          {"larger", s.larger},
          {"irregular_vertices", s.irregular_vertices},
          {"singularities", s.singularities},
          {"area", {{"sigma", s.area_sigma}, {"min", s.area_min}, {"max", s.area_max}}},
          {"angle",
           {{"sigma", s.angle_sigma},
            {"min", s.angle_min},
            {"max", s.angle_max},
            {"min_mean", s.angle_min_mean},
            {"max_mean", s.angle_max_mean}}},
          {"edge", {{"mean", s.edge_mean}, {"sigma", s.edge_sigma}}},
          {"inverted_quads", s.inverted_quads},
          {"scaled_jacobian", {{"min", s.jacobian_min}, {"p01", s.jacobian_p01}}},
          {"components", s.components},
          {"boundary_loops", s.boundary_loops},
          {"non_manifold_edges", s.non_manifold_edges},
          {"non_manifold_vertices", s.non_manifold_vertices},
          {"isolated_vertices", s.isolated_vertices},
          {"marked_edges", s.marked_edges},
          {"euler", s.euler}};
}

std::string symmetry(const Symmetry& symmetry) {
  if (symmetry.automatic) return "auto";
  std::string axes;
  for (std::size_t k = 0; k < 3; ++k) {
    if (symmetry.axes[k]) axes += "xyz"[k];
  }
  return axes.empty() ? "off" : axes;
}

Json creases(const FeatureOptions& features) {
  if (features.creases == Creases::by_angle) return features.crease_degrees;
  if (features.creases == Creases::marked) return "marked";
  return features.creases == Creases::automatic ? "auto" : "off";
}

Json to_json(const SurfaceDistance& distance) {
  return {{"mean", distance.mean}, {"max", distance.max}};
}

Json to_json(const RemeshReport& report) {
  Json stages = Json::array();
  for (const StageTime& stage : report.stages) {
    stages.push_back({{"name", stage.name}, {"seconds", stage.seconds}});
  }
  return {{"stages", stages},
          {"graph", {{"nodes", report.nodes}, {"edges", report.edges}, {"levels", report.levels}}},
          {"edge_length", report.edge_length},
          {"singularities",
           {{"orientation", number_or_null(report.orientation_singularities)},
            {"position", number_or_null(report.position_singularities)}}},
          {"energies",
           {{"orientation", energies(report.orientation_energies)},
            {"position", energies(report.position_energies)}}},
          {"notes", report.notes}};
}

Json to_json(const RemeshOptions& o) {
  const bool triangular = o.faces == OutputFaces::triangles || o.faces == OutputFaces::hexagons;
  Json json = {{"result", name_of(o.faces, output_faces)},
               {"rosy", o.rosy != 0  ? o.rosy
                        : triangular ? 6
                                     : 4},
               {"posy", triangular ? 6 : 4},
               {"scale", o.edge_length},
               {"faces", o.face_count},
               {"vertices", o.vertex_count},
               {"sizing", name_of(o.sizing.kind, sizing_kinds)},
               {"sizing_ratio", o.sizing.ratio},
               {"adaptive", o.sizing.adaptive},
               {"grading", o.sizing.grading},
               {"graph", name_of(o.graph.nodes, graph_nodes)},
               {"coarsen", o.coarsen},
               {"weights", name_of(o.graph.weights, graph_weights)},
               {"knn", o.graph.neighbors},
               {"crease_normals", o.graph.crease_degrees},
               {"crease", creases(o.features)},
               {"orientation_energy", name_of(o.orientation_energy, orientation_energies)},
               {"position_energy", name_of(o.position_energy, position_energies)},
               {"solver", name_of(o.solver.schedule, schedules)},
               {"sweeps", o.solver.sweeps > 0 ? Json(o.solver.sweeps) : Json("auto")},
               {"multiresolution", o.solver.multiresolution},
               {"seed", o.solver.seed},
               {"boundaries", o.features.align_border},
               {"guides", o.guides.size()},
               {"symmetry", symmetry(o.symmetry)},
               {"curvature", o.curvature.strength},
               {"curvature_hard", o.curvature.hard_degrees},
               {"bends", o.curvature.bends},
               {"smooth", o.smoothing},
               {"regularity", o.regularity},
               {"min_component", o.min_component},
               {"manifold", o.manifold},
               {"lock_borders", o.lock_borders},
               {"retries", o.retries}};
  if (o.sizing.kind == Sizing::Kind::distance) {
    const auto& p = o.sizing.point;
    json["sizing_point"] = {p.x(), p.y(), p.z()};
  }
  return json;
}

}  // namespace meshgrain::cli
