// SPDX-License-Identifier: GPL-2.0-or-later
// From moves to pieces: joins straight lines, rounds corners, and cuts the result into pieces with separate
// limits.
#pragma once

#include <array>

#include "trajectory/path/corner.hh"
#include "trajectory/tuning.hh"

namespace mw::trajectory {

/// The newest move may still grow; the one before it is open until the corner between the two is known. What
/// is before that lies in the path as pieces.
class PathBuilder {
  public:
    /// A path begins at `start`.
    void begin(const Pose &start) noexcept;
    /// True if one more move fits while the executor is at `now`.
    static bool hasRoom(const PlannedPath &path, const Snapshot &now) noexcept;
    /// Appends a move that starts at `end()`; its length must be greater than 0. Returns its number.
    /// `isMerging`: nearly straight lines become one.
    Sequence add(PlannedPath &path, const Conditions &conditions, const Primitive &primitive,
                 const MoveRequest &request, bool isMerging) noexcept;
    /// Nothing follows for now: the last move goes to its very end.
    void release_end(PlannedPath &path, const Conditions &conditions) noexcept;
    /// Something hangs on the end of the newest move: it does not grow any more.
    void keep_end() noexcept { isJoinable_ = false; }

    /// Where the next move starts.
    const Pose &end() const noexcept { return end_; }
    /// There are moves that are not yet whole pieces.
    bool hasOpenEnd() const noexcept { return open_.move != 0 || newest_ != 0; }
    /// The first of them, 0: none.
    Sequence first_open() const noexcept { return open_.move != 0 ? open_.move : newest_; }
    /// The last move that follows a spindle.
    Sequence last_synched() const noexcept { return last_synched_; }

  private:
    bool canGrow(const PlannedPath &path, const Primitive &line, const MoveRequest &request) const noexcept;
    bool grow(PlannedPath &path, const Primitive &line, const MoveRequest &request) noexcept;
    void fill_move(PlannedPath &path, Sequence n, const Primitive &primitive,
                   const MoveRequest &request) noexcept;
    void open_newest(PlannedPath &path, const Conditions &c) noexcept;
    Corner fresh_corner(const PlannedPath &path, Sequence n) const noexcept;
    // --- path_pieces.cc
    void close(PlannedPath &path, const Conditions &c, double to, const Corner &after) noexcept;
    void add_blend(PlannedPath &path, const Conditions &c, double d) noexcept;
    void add_part(PlannedPath &path, const Conditions &c, Piece piece, double to) noexcept;
    void add_piece(PlannedPath &path, const Conditions &c, const Piece &piece,
                   const SpeedLimit &limit) noexcept;

    Pose end_;
    /// A move whose end is not yet joined or released.
    struct Open {
        Sequence move = 0;    ///< 0: none
        double offset = 0;    ///< where its own part begins
        bool isStop = false;  ///< stop before the next piece
    };
    Open open_;
    Sequence newest_ = 0;  ///< the newest move, which may still grow, 0: none
    Sequence last_synched_ = 0;
    std::array<Pose, PathTuning::MOST_JOINED> joined_{};  ///< ends within it of the lines that it replaces
    std::size_t joined_count_ = 0;
    bool isJoinable_ = false;  ///< nothing else depends on its end
};

}  // namespace mw::trajectory
