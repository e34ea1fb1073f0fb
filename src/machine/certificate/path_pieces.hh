// SPDX-License-Identifier: GPL-2.0-or-later
// The programmed path as a queue of pieces: lines, and parts of arcs.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "base/geometry/move_settings.hh"
#include "base/geometry/pose.hh"
#include "gcode/analysis/programmed_piece.hh"
#include "motion/interface/path_command.hh"

namespace mw::machine {

/// The move of a path command that begins at `start`; nothing for commands that are not moves. Rigid tapping
/// returns to its start.
std::optional<gcode::ProgrammedPiece> programmed_piece(const geometry::Pose &start,
                                                       const motion::PathBody &body);

/// Source position of a move.
struct ProgramLine {
    std::int32_t line = 0;         ///< 0: unknown
    std::uint32_t file_index = 0;  ///< task's table of files
};

struct ProgrammedMove {
    std::uint64_t id = 0;  ///< increases from move to move
    gcode::ProgrammedPiece piece;
    geometry::PathMode mode = geometry::PathMode::BLEND;
    double tolerance = 0;  ///< in BLEND: the maximum distance from the path [machine units, degrees]; 0: none
    ProgramLine source;
    bool isMeasured = true;  ///< false: the motion does not follow the path (rigid tapping)
};

/// Tolerance of the exact path: the maximum distance in G61 and G61.1 [machine units, degrees].
inline constexpr double EXACT_TOLERANCE = 1e-6;

/// Relation of a piece to the previous piece.
enum class PieceStart : std::uint8_t {
    AT_CORNER,  ///< the path continues from the previous piece
    AFTER_END,  ///< the previous piece is executed to its end first
    ANYWHERE,   ///< the previous piece may have been left before its end (probe, abort)
};

/// A line, or a part of an arc.
struct PathPiece {
    gcode::PieceShape shape;
    std::uint64_t id = 0;
    double tolerance = 0;  ///< EXACT_TOLERANCE in exact modes
    bool isExact = false, isMeasured = true;
    PieceStart start = PieceStart::AT_CORNER;
    ProgramLine source;
};

/// Pieces have consecutive numbers. They are created when needed, because an arc may have any number of
/// revolutions. All calls come from one thread.
class PathPieces {
  public:
    void add(const ProgrammedMove &move);

    /// Number of the first stored piece.
    std::uint64_t first() const { return first_; }
    /// True if the piece exists; creates it if its move has arrived.
    bool has(std::uint64_t number);
    bool isMade(std::uint64_t number) const { return number - first_ < pieces_.size(); }
    const PathPiece &operator[](std::uint64_t number) const { return pieces_[number - first_]; }
    /// True if the path continues after the corner at the end of the piece.
    bool continues(std::uint64_t number) {
        return has(number + 1) && (*this)[number + 1].start == PieceStart::AT_CORNER;
    }
    void drop_before(std::uint64_t number);

    /// Start of the next section of the path, if the number of its first move is at most `id`. Within a
    /// section, pieces continue at corners.
    std::optional<PieceStart> due_section(std::uint64_t id) const;
    /// Drops all pieces before the last section that starts with a move up to `id`.
    void begin_section(std::uint64_t id);

  private:
    /// A move whose pieces are not all created.
    struct WaitingMove {
        PathPiece whole;
        int parts = 1, made = 0;
    };
    struct Section {
        std::uint64_t id = 0;  ///< id of its first move
        PieceStart start = PieceStart::ANYWHERE;
    };

    std::deque<WaitingMove> waiting_;
    std::deque<PathPiece> pieces_;
    std::uint64_t first_ = 0;
    std::deque<Section> sections_;  ///< sections that have not begun
    bool hasMove_ = false, isLastMeasured_ = true;
    geometry::Pose last_end_;
};

}  // namespace mw::machine
