// SPDX-License-Identifier: GPL-2.0-or-later
// The geometry parameters of a machine, declared once: a row of a table is a value of the model, a pin of the
// module and a line of its manual page.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "kinematics/kinematics.hh"

namespace mw::kinematics {

/// Type of the HAL pin or parameter.
enum class PinKind : std::uint8_t {
    FLOAT,        ///< float, in
    FLOAT_IO,     ///< float, in and out
    FLOAT_PARAM,  ///< float, a parameter
    S32,          ///< s32, in
    U32,          ///< u32, in
    U32_IO,       ///< u32, in and out
};

struct Parameter {
    const char *name;
    double start = 0;
    const char *unit = "";  ///< "" if there is none
    const char *doc = "";
    PinKind kind = PinKind::FLOAT;
};

/// A model with the geometry parameters in TABLE.
template <const auto &TABLE>
class Parametric : public Kinematics {
  public:
    static constexpr const auto &PARAMETERS = TABLE;
    static constexpr std::size_t COUNT = std::size(TABLE);

    constexpr Parametric() noexcept {
        for (std::size_t i = 0; i < COUNT; ++i) {
            values_[i] = TABLE[i].start;
        }
    }
    Kind kind() const noexcept override { return Kind::BOTH; }
    constexpr void set(std::size_t index, double value) noexcept { values_[index] = value; }
    constexpr double get(std::size_t index) const noexcept { return values_[index]; }

  protected:
    ~Parametric() = default;

  private:
    std::array<double, COUNT> values_{};
};

}  // namespace mw::kinematics
