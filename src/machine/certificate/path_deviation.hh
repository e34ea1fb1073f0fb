// SPDX-License-Identifier: GPL-2.0-or-later
// The deviation of commanded positions from the programmed path, in order: samples and path are followed from
// start to end and never back (Frechet distance). It uses only the programmed moves and the samples, no
// results of the planner.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/geometry/pose.hh"
#include "machine/certificate/path_pieces.hh"

namespace mw::machine {

/// A distance of the commanded positions from the path, and its position.
struct Deviation {
    double linear = 0;     ///< over XYZUVW [machine units]
    double angular = 0;    ///< over ABC [degrees]
    double tolerance = 0;  ///< tolerance at this position; 0: none
    bool isExact = false;  ///< the mode is G61 or G61.1
    std::int64_t time_ns = 0;
    ProgramLine source;
    geometry::Pose position;  ///< commanded position; at a corner the corner itself

    double distance() const { return std::max(linear, angular); }
    /// Deviation divided by the tolerance; 0 without a tolerance.
    double ratio() const { return tolerance > 0 ? distance() / tolerance : 0; }
};

struct Deviations {
    Deviation largest;   ///< maximum distance
    Deviation tightest;  ///< maximum ratio to the tolerance, for moves with G64 P
    Deviation exact;     ///< maximum distance in G61 and G61.1

    void take(const Deviation &one);
    void take(const Deviations &others);
};

/// One thread; memory is bounded by the moves ahead of the commanded position. If parts of the path are near
/// each other, several assignments of the samples are followed at the same time, and the assignment with the
/// smallest deviation is used.
class PathDeviation {
  public:
    /// Moves arrive before the samples that execute them.
    void on_move(const ProgrammedMove &move) { pieces_.add(move); }
    /// A commanded position during program motion. `id` is that of the move being executed; 0: none.
    void on_sample(const geometry::Pose &p, std::uint64_t id, std::int64_t time_ns);
    /// Assigns the last sample without the next one.
    void flush();
    /// The path has been executed to its end; a remaining part of it counts as a deviation.
    void complete();

    /// All deviations up to the last assigned sample.
    Deviations deviations() const;
    /// The move at the last assigned sample.
    const ProgramLine &source() const { return source_; }
    bool isRapid() const { return isRapid_; }

  private:
    struct Sample {
        geometry::Pose p;
        std::int64_t time_ns = 0;
    };
    /// The step from a sample to the next.
    struct Step {
        gcode::PieceShape chord;  ///< line between both samples
        /// Maximum distance between the motion and its chord: 1/8 of the second differences.
        gcode::Slack sag;
        std::int64_t time_ns = 0;
    };
    /// One possible assignment of the samples to the path.
    struct Candidate {
        std::uint64_t piece = 0;  ///< number of the piece
        double fraction = 0;      ///< fraction of the piece
        double now = 0;           ///< deviation of the last sample
        double cost = 0;          ///< maximum deviation since `older` began
        double recent_cost = 0;
        std::size_t origin = 0;    ///< candidate from which this candidate comes since `recent` began
        Deviations older, recent;  ///< deviations before and since all candidates were marked
    };
    /// A candidate that passes corners within one step.
    struct Passing {
        Candidate candidate;
        double along = 0;  ///< fraction of the step
    };

    void start_sections(std::uint64_t id);
    /// Assigns a sample; `next` is the position after it.
    void advance(const Sample &sample, const geometry::Pose &next);
    void assign(const Sample &sample, const Step &step);
    Step step_to(const Sample &sample, const geometry::Pose &next) const;
    /// The better of both candidates after the corner at the end of the piece, if its deviation is within
    /// `limit`: `before` was on the piece at the last sample, `passing` has reached it in this step.
    std::optional<Passing> pass(const Candidate *before, const std::optional<Passing> &passing,
                                const Step &step, double limit);
    gcode::Nearest corner_distance(std::uint64_t number, const Step &step, double from) const;
    void add_corner(Candidate &candidate, const gcode::Nearest &nearest, std::int64_t time_ns) const;
    void move_to(Candidate &candidate, const Sample &sample, double from) const;
    static void add(Candidate &candidate, const Deviation &found);
    static bool isBetter(const Candidate &a, const Candidate &b);
    const Candidate &best() const;
    double bound(double cost, std::uint64_t number) const;
    void prune();
    void commit_common();
    void commit(const Candidate &candidate);

    PathPieces pieces_;
    std::vector<Candidate> candidates_, next_;  ///< by piece number
    std::uint32_t steps_ = 0;                   ///< number of steps since the last common commit
    Deviations committed_;
    /// The last sample, which is assigned when the next one is known.
    std::optional<Sample> pending_;
    Sample last_;
    geometry::Pose before_last_;
    bool hasLast_ = false, isRapid_ = false;
    ProgramLine source_;
};

}  // namespace mw::machine
