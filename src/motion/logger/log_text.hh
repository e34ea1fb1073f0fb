// SPDX-License-Identifier: GPL-2.0-or-later
// Task's commands to motion as lines of text, in the format of LinuxCNC's motion-logger.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/limits.hh"
#include "motion/interface/command.hh"
#include "motion/interface/parameters.hh"
#include "motion/interface/path_command.hh"

namespace mw::motion {

/// One thread. Settings arrive as a list at the start and are logged when it is complete (SetNumJoints), in
/// the order and with the names of LinuxCNC's tests. Later settings are logged at once.
class LogText {
  public:
    using Lines = std::vector<std::string>;
    LogText();

    Lines of(const Command &command);
    Lines of(const PathCommand &command);
    /// End of the path.
    const geometry::Pose &position() const { return position_; }

  private:
    struct Told;
    Lines settings(int num_joints);
    Lines joint_settings(int joint) const;
    Lines axis_settings(int axis) const;
    void note(const SetParameter &setting);
    double get(Parameter parameter, int index = 0) const;
    std::string move_words(const geometry::Pose &end, const MoveTerms &terms, MotionType type) const;
    Lines with_synch(const MoveTerms &terms, std::string line);

    static constexpr std::size_t INDEXES = MAX_JOINTS > MAX_AXES ? MAX_JOINTS : MAX_AXES;
    std::array<std::array<double, INDEXES>, PARAMETERS.size()> values_{};
    bool isConfigured_ = false;
    int num_spindles_ = 1;
    unsigned axes_ = 0;      ///< that have settings
    double synch_feed_ = 0;  ///< of the last move [machine units per turn]
    geometry::Pose position_;
};

}  // namespace mw::motion
