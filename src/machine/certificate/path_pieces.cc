// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/certificate/path_pieces.hh"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/overloaded.hh"

namespace mw::machine {
namespace {

using geometry::Pose;

constexpr double MOST_PART_RAD = std::numbers::pi / 4;  ///< maximum angle of an arc in one piece

double pose_distance(const Pose &a, const Pose &b) {
    const Pose d = a - b;
    return std::max(geometry::norm_linear(d), geometry::norm_abc(d));
}

}  // namespace

std::optional<gcode::ProgrammedPiece> programmed_piece(const geometry::Pose &start,
                                                       const motion::PathBody &body) {
    gcode::ProgrammedPiece piece;
    piece.start = start;
    const auto read = Overloaded{
        [&](const motion::Line &line) {
            piece.end = line.end;
            piece.isRapid = line.terms.isRapid;
            return true;
        },
        [&](const motion::Arc &arc) {
            piece.end = arc.end;
            piece.centre = arc.centre;
            piece.normal = arc.normal;
            piece.angle_rad = arc.angle_rad;
            piece.isInUvw = arc.isInUvw;
            return true;
        },
        [&](const motion::Probe &probe) {
            piece.end = probe.end;
            return true;
        },
        [&](const motion::RigidTap &) {
            piece.end = start;
            return true;
        },
        [](const motion::Flush &) { return false; },
        [](const motion::SynchedDigitalOutput &) { return false; },
        [](const motion::SynchedAnalogOutput &) { return false; },
    };
    return std::visit(read, body) ? std::optional(piece) : std::nullopt;
}

void PathPieces::add(const ProgrammedMove &move) {
    const gcode::ProgrammedPiece &shape = move.piece;
    const bool isJoined = hasMove_ && pose_distance(shape.start, last_end_) <= EXACT_TOLERANCE;
    const bool wasMeasured = isLastMeasured_;
    hasMove_ = true;
    last_end_ = shape.end;
    if (shape.angle_rad == 0 && shape.start == shape.end && isJoined && move.isMeasured) {
        return;
    }
    isLastMeasured_ = move.isMeasured;
    WaitingMove waiting{PathPiece{.shape = gcode::PieceShape(shape), .id = move.id, .source = move.source}};
    PathPiece &whole = waiting.whole;
    whole.isExact = move.mode != geometry::PathMode::BLEND;
    whole.tolerance = whole.isExact ? EXACT_TOLERANCE : move.tolerance;
    whole.isMeasured = move.isMeasured;
    whole.start = !isJoined                        ? PieceStart::ANYWHERE
                  : move.isMeasured && wasMeasured ? PieceStart::AT_CORNER
                                                   : PieceStart::AFTER_END;
    waiting.parts = std::max(1, static_cast<int>(std::ceil(std::abs(shape.angle_rad) / MOST_PART_RAD)));
    if (whole.start != PieceStart::AT_CORNER) {
        sections_.push_back({move.id, whole.start});
    }
    waiting_.push_back(std::move(waiting));
}

bool PathPieces::has(std::uint64_t number) {
    while (number >= first_ + pieces_.size() && !waiting_.empty()) {
        WaitingMove &move = waiting_.front();
        if (move.parts == 1) {
            pieces_.push_back(std::move(move.whole));
        } else {
            PathPiece part = move.whole;
            part.shape = gcode::PieceShape(move.whole.shape.part_of(move.made, move.parts));
            part.start = move.made == 0 ? part.start : PieceStart::AT_CORNER;
            pieces_.push_back(std::move(part));
        }
        if (++move.made == move.parts) {
            waiting_.pop_front();
        }
    }
    return number < first_ + pieces_.size();
}

void PathPieces::drop_before(std::uint64_t number) {
    while (first_ < number && !pieces_.empty()) {
        pieces_.pop_front();
        ++first_;
    }
}

std::optional<PieceStart> PathPieces::due_section(std::uint64_t id) const {
    const bool isDue = !sections_.empty() && sections_.front().id <= id;
    return isDue ? std::optional(sections_.front().start) : std::nullopt;
}

void PathPieces::begin_section(std::uint64_t id) {
    std::uint64_t begin = 0;
    while (!sections_.empty() && sections_.front().id <= id) {
        begin = sections_.front().id;
        sections_.pop_front();
    }
    while (!pieces_.empty() && pieces_.front().id < begin) {
        pieces_.pop_front();
        ++first_;
    }
    while (pieces_.empty() && !waiting_.empty() && waiting_.front().whole.id < begin) {
        waiting_.pop_front();
    }
}

}  // namespace mw::machine
