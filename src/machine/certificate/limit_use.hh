// SPDX-License-Identifier: GPL-2.0-or-later
// Velocity, acceleration and jerk of commanded positions, calculated from differences of the samples and
// compared with limits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/limits.hh"
#include "machine/certificate/path_deviation.hh"

namespace mw::machine {

enum class Derivative : std::uint8_t { VELOCITY, ACCELERATION, JERK };
inline constexpr std::size_t DERIVATIVES = 3;

/// The limited quantity: an axis, a joint, or the norm over X, Y and Z.
struct LimitedCoordinate {
    enum class Type : std::uint8_t { AXIS, JOINT, XYZ_NORM } type = Type::AXIS;
    int index = 0;           ///< number of the axis or joint
    bool isAngular = false;  ///< in degrees instead of machine units
    /// [unit/s], [unit/s^2], [unit/s^3]; infinity: none.
    std::array<double, DERIVATIVES> limit{};
};

/// The maximum of a derivative, and its position in the program.
struct LargestUse {
    /// The maximum, minus the error that the rounding of the positions can add to the differences.
    double value = 0;
    std::int64_t time_ns = 0;
    ProgramLine source;
};

struct CoordinateUse {
    LimitedCoordinate coordinate;
    std::array<LargestUse, DERIVATIVES> largest;

    bool hasLimit(std::size_t derivative) const;
    /// The maximum divided by the limit; 0 without a limit.
    double ratio(std::size_t derivative) const;
};

/// A ratio above this value exceeds a limit. The margin is the rounding of the limit itself.
inline constexpr double EXCEEDED = 1 + 1e-6;

/// For one thread.
class LimitUse {
  public:
    LimitUse(std::vector<LimitedCoordinate> coordinates, double period_s);

    struct Sample {
        geometry::Pose axes;
        std::array<double, MAX_JOINTS> joints{};
        std::int64_t time_ns = 0;
        ProgramLine source;
    };
    /// Stores the next position without a measurement.
    void remember(const Sample &sample);
    /// Measures the differences of the last remember().
    void measure(const Sample &sample);
    /// Starts a new history, because the positions are not continuous here.
    void restart() { known_ = 0; }

    const std::vector<CoordinateUse> &uses() const { return uses_; }

  private:
    static constexpr std::size_t CHANNELS = MAX_AXES + MAX_JOINTS;
    using Row = std::array<double, CHANNELS>;

    double value(const LimitedCoordinate &coordinate, std::size_t order) const;

    std::vector<CoordinateUse> uses_;
    std::array<double, DERIVATIVES + 1> per_period_{};  ///< 1, 1/T, 1/T^2, 1/T^3
    std::array<Row, DERIVATIVES + 1> difference_{};     ///< differences of each order; order 0 is the
                                                        ///< position
    std::size_t known_ = 0;                             ///< number of orders that are known
};

}  // namespace mw::machine
