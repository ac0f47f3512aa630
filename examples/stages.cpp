// Every stage by itself: plain values go in and come out, so that a program can look at them,
// replace them, or run a part again.

#include <meshgrain/meshgrain.h>

#include <array>
#include <iostream>

int main() {
  using namespace meshgrain;
  try {
    // One context carries threads, progress and cancellation through all calls.
    Context context;
    context.on_progress = [](std::string_view, double) {};

    Mesh surface = sample_shape("torus");
    clean(surface);
    const double length = 2 * edge_lengths(surface).mean;
    subdivide(surface, length / 2, context);
    sort_along_curve(surface, context);

    const Hierarchy hierarchy = build_hierarchy(build_graph(surface, {}, context), context);
    const Graph& graph = hierarchy.levels[0];
    std::cout << graph.size() << " nodes, " << hierarchy.levels.size() << " levels\n";

    // A solver that runs step by step, one sweep at a time, from the coarsest level to the finest.
    const auto orientations = OrientationSolver::create(hierarchy, {});
    int sweeps = 0;
    while (orientations->step(context)) ++sweeps;
    const double before = orientations->energy(context);

    // Run again on a part that was changed: here the first nodes, held to a direction.
    std::vector<Index> region;
    std::vector<OrientationConstraint> constraints;
    for (Index i = 0; i < 100; ++i) region.push_back(i);
    constraints.push_back({0, Vec3::UnitZ(), 1.0f});
    orientations->set_constraints(constraints);
    orientations->restart(region);
    orientations->solve(context);
    const OrientationField orientation = orientations->field();
    const auto singular = orientation_singularities(surface, graph.normals, orientation, context);
    std::cout << sweeps << " sweeps, energy " << before << ", then "
              << orientations->energy(context) << "; " << singular.size() << " singularities\n";

    const EdgeLength edge_length(static_cast<float>(length));
    const PositionField position =
        solve_position(hierarchy, orientation, edge_length, {}, {}, context);
    Extraction extraction = extract_mesh(graph, orientation, position, {}, context);
    smooth(extraction, surface, graph, {}, context);
    std::cout << extraction.mesh.faces.size() << " faces\n";

    // Both fields, as other programs can read them.
    write_fields("stages-fields.ply", {surface, orientation, position});
    const Fields again = read_fields("stages-fields.ply", context);
    write_mesh("stages.obj", extraction.mesh);
    return again.orientation.directions.size() == graph.size() && !extraction.mesh.faces.empty()
               ? 0
               : 1;
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
