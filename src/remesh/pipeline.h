#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "border/border_loops.h"
#include "border/border_sizing.h"
#include "cloud/cloud_border.h"
#include "features/find_features.h"
#include "features/guide_constraints.h"
#include "mesh/cut_apart.h"
#include "mesh/frame.h"
#include "mesh/surface_size.h"
#include "mesh/vertex_faces.h"
#include "meshgrain/extract.h"
#include "meshgrain/finish.h"
#include "meshgrain/hierarchy.h"
#include "meshgrain/remesh.h"
#include "meshgrain/statistics.h"
#include "remesh/flaws.h"
#include "remesh/inherent_crossings.h"
#include "remesh/stages.h"
#include "remesh/target.h"

namespace meshgrain {

/// The stages of remesh(), in their order: each leaves what the next ones need. Those up to the
/// graph are in pipeline_surface.cpp, those from there to the orientation field, and what is read
/// off in the end, in pipeline.cpp, positions and faces in pipeline_faces.cpp, and what is done
/// where these are not good enough in pipeline_attempts.cpp and pipeline_regularity.cpp.
class Pipeline {
 public:
  Pipeline(const Mesh& input, const RemeshOptions& options, const Context& context);
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// The mesh is of use only if it has fewer faults than these.
  void beat(const FaultCounts& faults) { to_beat_ = faults; }

  /// Nor does it do without all creases.
  void keep_creases() { keeps_creases_ = true; }
  /// That creases nobody asked for need, in sides of a face: those with less are left out (see
  /// feature_edges()), and all of them if it is infinite.
  double room_for_creases() const { return plan_.room_for_creases; }
  /// Whether faces follow any.
  bool follows_creases() const;

  /// The border is no price for valid faces.
  void keep_border() { keeps_border_ = true; }

  /// A clean surface of triangles (or points), about one unit large.
  void clean_up(Mesh input);
  /// A copy of that, in input units, if much of its border is seams and it is not too large; else
  /// empty.
  Mesh seamed_surface() const;

  /// Takes the noise out of a scan of a mechanical part.
  void sharpen();

  /// Not finer than the target needs it, by far the most of a large input's vertices.
  void coarsen();

  /// Fine enough for the target, and in the order of a curve.
  void refine();
  void build_graph();
  void find_lines();

  void build_levels();

  /// Pure quads whose lattice is twice as coarse as they are cannot follow lines that run along
  /// each other a face or two apart, nor limbs of few faces around. Where there are many of these,
  /// the lattice is as fine as the quads.
  void refine_for_details();
  void size_faces();

  /// Finer still where small faces are wanted.
  void refine_for_sizes();
  void orient();

  /// Positions and the mesh. Where a count was asked for and missed, again with edges that much
  /// longer or shorter. A few faces too many can be taken away one by one: that costs some
  /// regularity, so that more of it is allowed only when other lengths have not helped.
  void position_and_extract();

  /// Where the faces lose some of the surface, others are made before these are mended; and where
  /// they are crumpled, so that mending would take long and be in vain, those without some creases.
  void smooth_faces();

  /// Quads that are twisted even then leave the surface.
  void untwist_faces();
  /// Where the faces have lost some of the surface all the same, and others that are made then have
  /// flaws, too, the lattice of pure quads becomes as fine as these. Returns whether it did: the
  /// faces are to be made once more, then. Else lattices that start elsewhere are tried where there
  /// are flaws: some of the surface is lost, quads are nearly flat, or faces pass through each
  /// other and the surface does not.
  bool mend_flaws();
  /// Where refine_for_details() leaves inverted quads all the same, what there would be without it:
  /// that is kept if it has fewer of these and of crossings together.
  void try_coarser_lattice();
  /// Where more regularity than by default bends the grid into faults, what there is with half of
  /// the excess, or none: the first is kept that has less than half as many.
  void try_less_regular();
  /// Whether there are clearly fewer faults than there must be, see beat(): what is left to do does
  /// not make them fewer.
  bool is_of_use();
  /// Where there are no flaws, but far more irregular vertices than the orientation field needs,
  /// what there is with more regularity than was asked for: that is kept if it has fewer of them,
  /// no flaws either, and no worse shapes.
  void try_more_regular();

  /// Pure quads: irregular vertices that cancel each other out go.
  void untie_knots();

  /// When all is done. Of very many faces only if one is inverted.
  Faults find_faults();
  /// Of the surface that was remeshed.
  const Cuts& cuts() const { return cuts_; }
  /// Whether the surface has marked edges, besides those of creases that were found in it.
  bool has_marks() const;
  /// Whether the input has.
  bool was_marked() const { return was_marked_; }
  bool is_sharpened() const { return is_sharpened_; }
  /// Of the input, which are sharp so far (see round_again()).
  Mesh roundings() const;
  /// The mean side of a face, in input units.
  double face_side() const { return plan_.target.face_side(area_) * frame_.scale; }

  /// If quads alone could not meet borders that stay.
  void note_odd_borders();
  /// If there are many pieces smaller than a face.
  void note_scraps();
  /// If pieces fell apart, as where a strip is hardly wider than the hexagons left out along
  /// borders.
  void note_parted_hexagons();
  /// Their edge length and singularities.
  void report_fields();

  /// Another target, not finer than the one that all was prepared for.
  void change_target(const RemeshOptions& options);

  /// The mesh alone; the rest stays for the next one.
  RemeshResult take_mesh(const RemeshReport& prepared);
  RemeshReport report() const;
  RemeshResult result() &&;

 private:
  /// What faces are made from, as far as other faces may be made from something else.
  struct Plan {
    Target target;
    // What the cells of the lattice become: OutputFaces::quads are four each. Where they are to be
    // quads themselves, it is quad_dominant, and few of the others are left for extraction to mend.
    OutputFaces lattice_faces = OutputFaces::quads;
    EdgeLength lengths;
    std::uint64_t other_start = 0;  // of both fields; 0 for the usual one
    bool is_thorough = false;       // the orientation field, over flat sides as well
    OrientationField orientation;
    std::vector<EnergyRecord> orientation_energies;
    std::vector<std::uint8_t> keeps_singularities;  // the lattice; see ExtractOptions
    double room_for_creases = 0;                    // see room_for_creases()
    FeatureLines features;
    bool divides_borders = false;
    BorderLoops borders;  // that stay
    FeatureConstraints constraints;
    std::vector<std::string> notes;
  };
  /// The faces, and the positions that they were read from.
  struct FacesMade {
    Extraction extraction;
    bool is_split = false;  // into the quads that are written
    PositionField position;
    std::vector<EnergyRecord> position_energies;
  };
  struct Attempt {
    Plan plan;
    FacesMade made;
  };
  /// Faces before they are smoothed.
  struct RoughFaces {
    Extraction extraction;
    bool is_split = false;
  };

  /// Takes faces away until there are no more than wanted. Returns whether that came to be.
  bool take_faces_away(FacesMade& made);
  /// Adds strips of quads until there are as many faces as wanted. Returns whether that came to be;
  /// what is left is split then, else as it was.
  bool add_faces(FacesMade& made);
  /// Adds single quads, in the end, to a mesh that has too few faces.
  void add_single_faces();
  /// Takes strips of quads away, and single ones for the rest. Returns whether that needs no more
  /// than `most_single`: what is left is split then, else as it was.
  bool take_strips(FacesMade& made, std::size_t most_single);
  /// Pure quads: `change(quads, count, wanted)` is to bring what will be written from one number of
  /// faces to the other. If it returns true that is kept, split; else all is as it was.
  template <typename Change>
  bool change_quads(FacesMade& made, const Change& change);
  void add_notes(const std::vector<std::string>& notes);
  void clean_border();
  /// Whether seams along all of the border, which is given, are mostly cracks that no face of the
  /// size could keep.
  bool are_cracks(std::span<const std::array<Index, 2>> border) const;
  void drop_pieces();

  /// Quads with a corner of 180 degrees or more, and faces that look away from the surface.
  std::vector<Index> inverted_faces() const;
  /// Inverted faces, and pairs that pass through each other, be that inherent or not.
  std::size_t count_all_faults() const;
  /// Leaves no faces, but all that others can be made from.
  Attempt take_attempt();
  void put_back(Attempt&& attempt);
  /// As all is now. Returns whether there are any.
  bool make_faces_again();
  bool is_needlessly_irregular() const;
  /// Faces as regular as is aimed at now. Returns whether they are clearly more so than those
  /// before, and no worse.
  bool make_more_regular(const MeshStatistics& before, const Flaws& flaws_before);
  /// Whether faces that are tried are mended, or only smoothed, to be compared with others.
  enum class Mends { yes, no };
  /// Makes the faces once more, after a change of what they are made from, and smooths them. Keeps
  /// what was before, and returns false, unless these are better.
  bool try_again(const std::function<bool()>& is_better, const std::function<void()>& change = {},
                 Mends mends = Mends::yes);

  /// Without a look at creases. Returns false if the faces are crumpled, where that is asked: they
  /// have not been mended, then.
  bool smooth_faces_unless(const std::function<bool()>& are_crumpled);
  /// Returns false if they are not worth mending, and have not been.
  bool smooth_faces_if(const std::function<bool()>& is_worth_mending);
  /// position_and_extract(), but there may be no faces.
  void find_faces();
  void aim_at(OutputFaces lattice_faces);
  /// Whether there are few faces for how much the surface bends.
  bool is_coarse_for_bends() const;
  double share_of_holes() const;  // of the faces wanted
  /// The lattice may be as fine as the quads.
  bool may_have_fine_lattice() const;
  /// It must: given positions are for one.
  bool has_given_fine_lattice() const;
  /// Among more faces holes and ends are little to see, for twice the time and the memory.
  bool may_show_details() const;
  /// Edges between more than two faces: all of these would have to get the same new vertices.
  bool has_branches() const;
  /// Returns whether the lattice is finer now.
  bool choose_lattice();
  /// The surface, for the lattice that was chosen.
  void refine_for_lattice();
  /// None where that cannot be told.
  LostSurface lost_surface() const;
  Flaws flaws(double lost_faces);
  /// Those of these pairs that are not inherent.
  std::vector<std::array<Index, 2>> own(std::vector<std::array<Index, 2>> crossings);
  /// Limbs become thinner than they are, and are lost, where the rows around them are as many as
  /// at their ends: a lattice that has all its singularities there lets rows end.
  void keep_singularities_around(const std::vector<Index>& nodes);
  /// Makes the faces once more, so, if they have `lost` something when all is done. `left`: their
  /// flaws, before and after.
  void recover_lost_surface(const LostSurface& lost, Flaws& left);
  /// What there is without creases that nobody asked for, where faces could not follow them: the
  /// steps of a surface around voxels, or parts that are thinner than a face. First without those
  /// that have no room, then without any. Marked edges, such as the borders of materials, go with
  /// them. Returns whether that is better.
  bool try_without_creases(const Flaws& before, Mends mends = Mends::yes);
  bool leaves_out_creases() const { return plan_.room_for_creases == no_creases; }
  /// Whether there may be creases that nobody asked for.
  bool may_leave_out_creases() const;
  void keep_cone_tips();
  /// Of all edges of the faces, about those that follow lines.
  double share_of_lines() const;
  /// Whether there are more lines than edges that could follow them, as where each facet of a
  /// twisted bar or a thin hair counts as a crease.
  bool lines_have_no_room() const;
  /// What there is with borders that stay divided into edges as long as faces, where faces that
  /// meet far longer ones are folded. Returns whether that is better.
  bool try_divided_borders(const Flaws& before);
  /// Until none are left of the flaws that there were `before`.
  Flaws try_other_starts(Flaws before);
  /// Irregular vertices may be the price: not for those who want fewer of them than by default.
  bool may_be_irregular() const;
  /// Whether the mesh can still be of use, see beat().
  bool may_be_of_use(const FaultCounts& faults) const {
    return !to_beat_ || !faults.are_far_more_than(*to_beat_);
  }
  /// Whether what is wrong with the faces is to be seen, and to mend it would not take too long.
  bool shows_faults() const;
  /// Whether it may take the place of these to make others.
  bool may_make_others() const { return options_.retries && shows_faults(); }
  FeatureOptions feature_options() const;
  /// Those longer than the target allows. Returns whether there are any.
  bool split_long_edges(double area, const EdgeLengths& edges);

  /// Those that stay.
  void find_borders();
  void thin_out_cloud();
  /// Without outliers and noise, and with points between those that are few.
  Graph graph_of_cloud();
  /// Where it is not manifold, once nothing is split any more; and undoes that.
  void cut_surface();
  void join_cuts();
  /// Guides onto the surface: those that edges must follow are cut into it.
  void lay_guides(double edge_length);
  void append(const FeatureConstraints& more);
  /// Sorts the surface along a curve, and all that goes with its vertices.
  std::vector<Index> put_in_order();

  /// Whether quads are asked for, and the cells of the lattice are to be these quads.
  bool has_quads_alone() const;
  /// Which share of faces too many may be taken away again: more than the count may be off by only
  /// where that does no harm to sizes, guides, borders that stay, or the utmost regularity.
  double surplus() const;
  /// The middle of what will do, as a share of the count.
  double count_to_aim_at() const;
  /// How many faces lengths must be for, for each one that is wanted.
  double faces_to_ask_for() const;
  /// Lengths that have so many times the faces, but are what borders that stay need there. Returns
  /// whether there are any.
  bool fit_lengths_to_borders(double more_faces);
  /// Into the quads that are written.
  void split(Extraction& extraction) const;
  void finish_borders();
  SmoothOptions smooth_options() const;
  /// Of the lattice.
  double mean_length() const { return plan_.target.edge_length(area_); }
  double growth() const { return plan_.target.growth(options_.sizing.grading); }
  const Graph& graph() const { return hierarchy_.levels[0]; }
  /// What faces are finished over: their nodes are vertices of the surface then, or points.
  const Graph& finishing_graph() const {
    return nodes_are_vertices_ ? graph() : graph_of_vertices_;
  }
  /// All but the finest, which together are as large as it.
  void drop_coarse_levels();
  /// Those again, if they were dropped.
  void complete_levels();
  void solve_positions(FacesMade& made) const;

  /// What regularity may cost (ExtractOptions): the lattice of pure quads is twice as coarse as
  /// their edges, so that there the same cost bends the surface's grid over a longer way.
  double cancelling_cost(double regularity) const;
  Extraction extract(const PositionField& positions);

  const RemeshOptions& options_;
  const Context& context_;
  RemeshResult result_;
  Stages stage_;
  Frame frame_;
  Plan plan_;
  FacesMade made_;
  std::vector<BorderNode> cloud_border_;
  bool is_cloud_, nodes_are_vertices_;
  bool has_thin_limbs_ = false;     // for its faces, see is_coarse_for_bends()
  RemeshOptions wanted_;            // what the target goes by
  double regularity_;               // that is aimed at
  std::size_t clean_vertices_ = 0;  // of the input, without what clean_up() takes out
  bool is_in_order_ = false;        // the surface, since it was read
  bool was_marked_ = false;         // the input
  bool is_sharpened_ = false;
  Mesh roundings_;             // of the surface, which are sharp
  bool is_coarsened_ = false;  // its creases are marked since then, and
  bool had_marks_ = false;     // others were before
  bool is_seamed_ = false;     // much of its border
  Mesh surface_;
  std::optional<InherentCrossings> inherent_crossings_;  // once they are asked for
  Cuts cuts_;                                            // of the surface, while it has a graph
  VertexFaces around_;                                   // its vertices, once it has a graph
  SurfaceSize input_size_{};                             // of the surface before it is refined
  Hierarchy hierarchy_;
  bool has_all_levels_ = false;
  Graph graph_of_vertices_;  // if that of the hierarchy is of faces
  double area_ = 0;
  std::vector<std::uint8_t>
      locked_;  // one flag a vertex of the surface; of RemeshOptions::lock_borders
  BorderSpacing border_spacing_;
  EdgeLength free_lengths_;            // what lengths would be without these borders
  GuideLines guides_;                  // that edges follow
  std::vector<GuideRun> soft_guides_;  // that fields are drawn to
  static constexpr double no_creases = std::numeric_limits<double>::infinity();
  bool has_tried_without_creases_ = false;  // for the faces that there are
  RoughFaces rough_;                        // of those that were smoothed last
  FeatureLines border_lines_;               // which vertices slide along if the graph is of faces
  bool may_have_faults_ = true;             // what is done after mend_flaws() adds none
  std::optional<FaultCounts> to_beat_;      // see beat()
  bool keeps_border_ = false, keeps_creases_ = false;
};

}  // namespace meshgrain
