// SPDX-License-Identifier: GPL-2.0-or-later
// Homing by a user's module, through the C functions of homing.h. The module commands the joints; this class
// clamps its commands to the limits of each joint.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "hal/include/homing.h"
#include "motion/homing/module.hh"

namespace mw::motion {

/// Functions of the module that motion calls; other programs call the rest.
struct HomingFunctions {
    decltype(&::homeMotFunctions) homeMotFunctions = nullptr;
    decltype(&::homing_init) homing_init = nullptr;
    decltype(&::read_homing_in_pins) read_homing_in_pins = nullptr;
    decltype(&::write_homing_out_pins) write_homing_out_pins = nullptr;
    decltype(&::do_home_joint) do_home_joint = nullptr;
    decltype(&::do_cancel_homing) do_cancel_homing = nullptr;
    decltype(&::do_homing) do_homing = nullptr;
    decltype(&::set_unhomed) set_unhomed = nullptr;
    decltype(&::set_joint_homing_params) set_joint_homing_params = nullptr;
    decltype(&::update_joint_homing_params) update_joint_homing_params = nullptr;
    decltype(&::get_homing) get_homing = nullptr;
    decltype(&::get_homed) get_homed = nullptr;
    decltype(&::get_homing_is_active) get_homing_is_active = nullptr;
    decltype(&::get_index_enable) get_index_enable = nullptr;
    decltype(&::get_homing_at_index_search_wait) get_homing_at_index_search_wait = nullptr;
};

/// Number of joints of the machine; no pose moves the last `extra` ones.
struct JointCounts {
    int all = 0, extra = 0;
};

class ModuleHoming final : public homing::Module {
  public:
    enum class Found : std::uint8_t { NONE, SOME, ALL };
    /// Looks for the functions in the loaded modules; `missing` is the first missing function. [while
    /// loading]
    Found find(const char *&missing) noexcept;
    /// Keeps the module loaded as long as component `comp_id`. Returns 0 or a negated errno. [while loading]
    int hold(int comp_id) const noexcept;
    /// Starts the module, which makes its pins. `on_unlock` and `on_ask` call set_unlock() and isUnlocked().
    /// Returns 0 or its error code. [while loading]
    int start_module(int comp_id, double period_s, JointCounts counts, void (*on_unlock)(int, int),
                     int (*on_ask)(int)) noexcept;

    void set_unlock(int joint, bool isWanted) noexcept;
    bool isUnlocked(int joint) const noexcept { return (unlocked_ >> joint & 1U) != 0; }

    void set_num_joints(int) noexcept override {}
    void configure(int joint, const homing::Parameters &parameters) noexcept override;
    void start(int joint) noexcept override;
    void abort(homing::event::Event why, int joint) noexcept override;
    void unhome(int joint) noexcept override;
    void read_pins() noexcept override { functions_.read_homing_in_pins(num_joints_); }
    void step(const homing::JointInput *inputs, homing::JointCommand *commands) noexcept override;
    void write_pins() noexcept override { functions_.write_homing_out_pins(num_joints_); }
    void lock() noexcept override { unlock_ = 0; }

    bool isHoming(int joint) const noexcept override { return functions_.get_homing(joint); }
    bool isHomed(int joint) const noexcept override { return functions_.get_homed(joint); }
    bool isActive() const noexcept override { return functions_.get_homing_is_active(); }
    bool hasWork() const noexcept override { return true; }
    int step_number(int joint) const noexcept override { return isHoming(joint) ? 1 : 0; }
    bool isIndexWanted(int) const noexcept override { return false; }
    bool isAtIndex(int joint) const noexcept override;
    bool isUnlockWanted(int joint) const noexcept override { return (unlock_ >> joint & 1U) != 0; }
    int take_failure(homing::Failure &why) noexcept override;
    std::uint32_t take_clamped() noexcept override;

  private:
    void show(int joint, const homing::JointInput &in) noexcept;
    void take_offset(int joint, const homing::JointInput &in, bool wasAtIndex,
                     homing::JointCommand &out) noexcept;
    void take_move(int joint, const homing::JointInput &in, homing::JointCommand &out) noexcept;
    void clamp(int joint) noexcept;

    HomingFunctions functions_;
    std::array<emcmot_joint_t, MAX_JOINTS> joints_{};  ///< data for the module
    std::array<homing::Parameters, MAX_JOINTS> parameters_{};
    int num_joints_ = 0;
    std::uint32_t configured_ = 0, driven_ = 0, unlock_ = 0, unlocked_ = 0;  ///< bit per joint
    std::uint32_t clamped_ = 0, told_ = 0;
    std::uint32_t begun_ = 0;  ///< bit per joint whose start position is in `origin_`
    std::array<double, MAX_JOINTS> origin_{};
    bool isCancelled_ = true;  ///< the module's commands have no effect until homing starts
};

}  // namespace mw::motion
