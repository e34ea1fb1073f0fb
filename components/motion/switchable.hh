// SPDX-License-Identifier: GPL-2.0-or-later
// Modules that can be switched between a model and identity, where each joint is an axis: type 0 is the model
// and type 1 identity, or the other way round with sparm=identityfirst. coordinates= are the letters of the
// joints.
#pragma once

#include <atomic>

#include "components/motion/model_pins.hh"
#include "kins/trivial.hh"

namespace mw::components {

/// `Live` has forward and inverse.
template <class Live>
class Switchable {
  public:
    Switchable(const Live &live, int identity_type) noexcept : live_(live), identity_type_(identity_type) {}

    /// Reads the arguments of the load and makes the pins kinstype.is-N. 0 or a negated errno, with a message
    /// in the log. [while loading]
    int declare(int comp_id, const char *module, const char *letters, const char *sparm) noexcept {
        if (!identity_.configure(letters)) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: coordinates=%s: expected up to 16 of the letters XYZABCUVW\n",
                            module, letters);
            return -EINVAL;
        }
        if (sparm != nullptr && sparm[0] != '\0') {
            if (!isSame(sparm, "identityfirst")) {
                rtapi_print_msg(RTAPI_MSG_ERR, "%s: sparm=%s: expected identityfirst\n", module, sparm);
                return -EINVAL;
            }
            identity_type_ = 0;
        }
        pins_ = static_cast<hal_bit_t **>(hal_malloc(TYPES * static_cast<long>(sizeof(hal_bit_t *))));
        if (pins_ == nullptr) {
            return -ENOMEM;
        }
        for (int type = 0; type < TYPES; ++type) {
            const int status = hal_pin_bit_newf(HAL_OUT, &pins_[type], comp_id, "kinstype.is-%d", type);
            if (status < 0) {
                return status;
            }
            *pins_[type] = type == 0;
        }
        return 0;
    }
    /// 0 when there is such a type. While nothing moves. [servo]
    int switch_to(int type) noexcept {
        if (type < 0 || type >= OUR_TYPES) {
            return -1;
        }
        type_.store(type, std::memory_order_release);
        for (int i = 0; i < TYPES; ++i) {
            *pins_[i] = i == type;
        }
        return 0;
    }
    kins::Status forward(const double *joints, kins::Pose &pose) const noexcept {
        return isIdentity() ? identity_.forward(joints, pose) : live_.forward(joints, pose);
    }
    kins::Status inverse(const kins::Pose &pose, double *joints) const noexcept {
        return isIdentity() ? identity_.inverse(pose, joints) : live_.inverse(pose, joints);
    }
    int side(const kins::Pose &pose) const noexcept { return isIdentity() ? 0 : model_side(live_, pose); }

  private:
    static constexpr int TYPES = 3;      ///< with a pin of their own
    static constexpr int OUR_TYPES = 2;  ///< a third is a user's

    static bool isSame(const char *a, const char *b) noexcept {
        while (*a != '\0' && *a == *b) {
            ++a;
            ++b;
        }
        return *a == *b;
    }
    /// Pairs with switch_to: the planner's thread sees a type only whole.
    bool isIdentity() const noexcept { return type_.load(std::memory_order_acquire) == identity_type_; }

    const Live &live_;
    kins::Trivial identity_;
    std::atomic<int> type_{0};
    int identity_type_;
    hal_bit_t **pins_ = nullptr;
};

}  // namespace mw::components

/// Type 0 is the model.
#define MW_SWITCHABLE_MODULE(live, name, default_letters, declare_model)                                     \
    MW_SWITCHABLE_MODULE_FROM(live, name, default_letters, declare_model, 1)

/// The arguments, the functions and the loading of such a module. `live` is an object with forward and
/// inverse; `declare_model(comp_id, letters)` makes its pins and takes its letters, 0 or a negated errno.
#define MW_SWITCHABLE_MODULE_FROM(live, name, default_letters, declare_model, identity_type)                 \
    static char *coordinates;                                                                                \
    RTAPI_MP_STRING(coordinates, "axis letters in the order of the joints");                                 \
    static char *sparm;                                                                                      \
    RTAPI_MP_STRING(sparm, "identityfirst: type 0 is identity");                                             \
    static mw::components::Switchable switchable(live, identity_type);                                       \
    static int component = -1;                                                                               \
    MW_KINEMATICS_FUNCTIONS(switchable);                                                                     \
    MW_KINEMATICS_PURE;                                                                                      \
    extern "C" int kinematicsSwitchable(void) {                                                              \
        return 1;                                                                                            \
    }                                                                                                        \
    extern "C" int kinematicsSwitch(int type) {                                                              \
        return switchable.switch_to(type);                                                                   \
    }                                                                                                        \
    EXPORT_SYMBOL(kinematicsSwitchable);                                                                     \
    EXPORT_SYMBOL(kinematicsSwitch);                                                                         \
    int rtapi_app_main(void) {                                                                               \
        const char *letters =                                                                                \
            coordinates != nullptr && coordinates[0] != '\0' ? coordinates : default_letters;                \
        component = hal_init(name);                                                                          \
        int status = component < 0 ? component : switchable.declare(component, name, letters, sparm);        \
        status = status < 0 ? status : declare_model(component, letters);                                    \
        if (status < 0) {                                                                                    \
            hal_exit(component);                                                                             \
            return status;                                                                                   \
        }                                                                                                    \
        return hal_ready(component);                                                                         \
    }                                                                                                        \
    void rtapi_app_exit(void) {                                                                              \
        hal_exit(component);                                                                                 \
    }                                                                                                        \
    static_assert(true)
