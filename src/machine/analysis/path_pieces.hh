// SPDX-License-Identifier: GPL-2.0-or-later
// The programmed path as a queue of pieces: lines, and parts of arcs.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "base/geometry/move_settings.hh"
#include "base/geometry/pose.hh"
#include "machine/analysis/programmed_piece.hh"

namespace mw::machine {

/// Where a move comes from.
struct ProgramLine {
    std::int32_t line = 0;         ///< 0: unknown
    std::uint32_t file_index = 0;  ///< task's table of files
};

struct ProgrammedMove {
    std::uint64_t id = 0;  ///< increases from move to move
    ProgrammedPiece piece;
    geometry::PathMode mode = geometry::PathMode::BLEND;
    double tolerance = 0;  ///< in BLEND: the maximum distance from the path [machine units, degrees]; 0: none
    ProgramLine source;
    bool isMeasured = true;  ///< false: the move does not follow the path (rigid tapping)
};

/// What "exact path" means: the maximum distance in G61 and G61.1 [machine units, degrees].
inline constexpr double EXACT_TOLERANCE = 1e-6;

/// How a piece begins.
enum class PieceStart : std::uint8_t {
    AT_CORNER,  ///< the path continues from the piece before
    AFTER_END,  ///< the piece before is executed to its end first
    ANYWHERE,   ///< the piece before may have been left (probe, abort)
};

/// A line, or a part of an arc.
struct PathPiece {
    PieceShape shape;
    std::uint64_t id = 0;
    double tolerance = 0;  ///< EXACT_TOLERANCE where the mode is exact
    bool isExact = false, isMeasured = true;
    PieceStart start = PieceStart::AT_CORNER;
    ProgramLine source;
};

/// Pieces have consecutive numbers. They are made when they are needed: an arc may have any number of
/// revolutions. One thread.
class PathPieces {
  public:
    void add(const ProgrammedMove &move);

    /// Number of the first piece that is kept.
    std::uint64_t first() const { return first_; }
    /// True when the piece exists; makes it if its move has arrived.
    bool has(std::uint64_t number);
    bool isMade(std::uint64_t number) const { return number - first_ < pieces_.size(); }
    const PathPiece &operator[](std::uint64_t number) const { return pieces_[number - first_]; }
    /// The path continues over the corner at the end of the piece.
    bool continues(std::uint64_t number) {
        return has(number + 1) && (*this)[number + 1].start == PieceStart::AT_CORNER;
    }
    void drop_before(std::uint64_t number);

    /// How the next section of the path starts, if the number of its first move is at most `id`. Within a
    /// section, pieces continue at corners.
    std::optional<PieceStart> due_section(std::uint64_t id) const;
    /// Drops all before the last section that starts with a move up to `id`.
    void begin_section(std::uint64_t id);

  private:
    /// A move of which not all pieces are made.
    struct WaitingMove {
        PathPiece whole;
        int parts = 1, made = 0;
    };
    struct Section {
        std::uint64_t id = 0;  ///< of its first move
        PieceStart start = PieceStart::ANYWHERE;
    };

    std::deque<WaitingMove> waiting_;
    std::deque<PathPiece> pieces_;
    std::uint64_t first_ = 0;
    std::deque<Section> sections_;  ///< not begun
    bool hasMove_ = false, isLastMeasured_ = true;
    geometry::Pose last_end_;
};

}  // namespace mw::machine
