// SPDX-License-Identifier: GPL-2.0-or-later
// A canon that prints its calls, one line each, as the standalone interpreter does.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>

#include "base/text.hh"
#include "gcode/canon/canon.hh"

namespace mw::gcode {

/// Prints "%5d N..... CALL(arguments)" per call and the text of (print,...). Prints (log...) as calls: it
/// writes no files.
class PrintCanon final : public Canon {
  public:
    explicit PrintCanon(std::FILE *out);
    PrintCanon(const PrintCanon &) = delete;
    PrintCanon &operator=(const PrintCanon &) = delete;

    void begin_block(const BlockRef &block) override;
    void take(const CanonCall &call) override;

  private:
    /// A coordinate and its printed text.
    struct Coordinate {
        std::uint64_t bits = 0;
        std::size_t length = 0;
        std::array<char, FIXED4_SIZE> text{};
    };
    static constexpr std::size_t COUNTER_WIDTH = 15, MOST_PREFIX = 12;
    static constexpr std::size_t MOST_HEAD = COUNTER_WIDTH + MOST_PREFIX + 2;

    /// Prints a call by its NAME and FIELDS.
    template <RegularCall Call>
    void write(const Call &call);
    // Calls with their own format.
    void write(const OnReset &call);
    void write(const Finish &call);
    void write(const StraightTraverse &call) { write_straight(call); }
    void write(const StraightFeed &call) { write_straight(call); }
    void write(const UseToolLengthOffset &call);
    void write(const SetFeedMode &call);
    void write(const SetMotionControlMode &call);
    void write(const SetPlannerMode &call);
    void write(const ArcFeed &call);
    void write(const NurbsFeed &call);
    void write(const StraightProbe &call);
    void write(const StartSpeedFeedSynch &call);
    void write(const SetSpindleMode &call);
    void write(const WaitOrientComplete &call);
    void write(const SetToolTableEntry &call);
    void write(const SetAnalogOutput &call);
    void write(const PrintLine &call);
    void write(const CanonError &call);
    /// The standalone program has no inputs and no probe, so it does not wait.
    void write(const WaitInput &) {}
    void write(const LogProbes &) {}
    /// Straight moves, the most frequent calls. [NAME and FIELDS as in write()]
    template <class Call>
    void write_straight(const Call &call);

    void count_line();
    void set_prefix(std::string_view prefix);
    void put(std::string_view call);
    // Builds line_: first the prefix, then the call.
    void begin_line();
    void end_line();

    std::FILE *out_;
    bool is_terminal_ = false;
    bool prefix_numbered_ = false;
    std::string line_;
    std::array<Coordinate, geometry::AXIS_U> coordinates_;
    /// Prefix of the next line: the counter, right-aligned; the block number; a blank after each. Twice the
    /// maximum length, so that a block of a fixed size can be copied from any position of the counter.
    std::array<char, 2 * MOST_HEAD> head_{};
    std::size_t head_begin_ = COUNTER_WIDTH - 5;  ///< at least five digits
    std::size_t head_end_ = 0;
};

}  // namespace mw::gcode
