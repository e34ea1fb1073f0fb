// SPDX-License-Identifier: GPL-2.0-or-later
// Modules of several types of kinematics, switched by motion.switchkins-type: models, identity (each joint is
// an axis), and kinematics of the user. Type 0 is the model, type 1 identity, type 2 the kinematics of the
// user; with sparm=identityfirst identity is type 0 and the model type 1. coordinates= are the letters of the
// joints.
#pragma once

#include <array>
#include <atomic>

#include "components/motion/model_pins.hh"
#include "components/motion/user_type.hh"
#include "kinematics/trivial.hh"

namespace mw::components {

/// `Live` provides forward and inverse.
template <class Live>
class PartOf final : public TypePart {
  public:
    explicit PartOf(const Live &live) noexcept : live_(live) {}
    kinematics::Status forward(const double *joints, kinematics::Pose &pose) const noexcept override {
        return live_.forward(joints, pose);
    }
    kinematics::Status inverse(const kinematics::Pose &pose, double *joints) const noexcept override {
        return live_.inverse(pose, joints);
    }
    int side(const kinematics::Pose &pose) const noexcept override { return model_side(live_, pose); }
    void watch(const double *joints) const noexcept override {
        if constexpr (requires { live_.watch(joints); }) {
            live_.watch(joints);
        }
    }

  private:
    const Live &live_;
};

class Switchable {
  public:
    /// Types: model, identity, user.
    explicit Switchable(const TypePart &model) noexcept : types_{&model, &identity_, &user_} {}
    /// Types: identity and one or two models; none is a user type.
    Switchable(const TypePart *model, const TypePart *second) noexcept : types_{&identity_, model, second} {}
    Switchable(const Switchable &) = delete;
    Switchable &operator=(const Switchable &) = delete;

    /// Reads the load arguments and creates the pins kinstype.is-N. Returns 0, or a negated errno with a
    /// message in the log. [while loading]
    int declare(int comp_id, const char *module, const char *letters, const char *sparm) noexcept {
        if (!letters_.configure(letters)) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: coordinates=%s: expected up to 16 of the letters XYZABCUVW\n",
                            module, letters);
            return -EINVAL;
        }
        const bool is_users = types_[MAX_TYPES - 1] == &user_;
        int status = is_users ? user_.declare(comp_id, module, letters, sparm) : 0;
        if (status < 0) {
            return status;
        }
        if (sparm != nullptr && isSame(sparm, "identityfirst")) {
            types_[1] = types_[0] == &identity_ ? types_[1] : types_[0];
            types_[0] = &identity_;
        } else if (sparm != nullptr && sparm[0] != '\0' && !user_.isThere()) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: sparm=%s: expected identityfirst\n", module, sparm);
            return -EINVAL;
        }
        pins_ = static_cast<hal_bit_t **>(hal_malloc(MAX_TYPES * static_cast<long>(sizeof(hal_bit_t *))));
        if (pins_ == nullptr) {
            return -ENOMEM;
        }
        for (int type = 0; type < count(); ++type) {
            status = hal_pin_bit_newf(HAL_OUT, &pins_[type], comp_id, "kinstype.is-%d", type);
            if (status < 0) {
                return status;
            }
            *pins_[type] = type == 0;
        }
        return 0;
    }
    /// Returns 0 when the type exists. Only while nothing moves. [servo]
    int switch_to(int type) noexcept {
        if (type < 0 || type >= count()) {
            return -1;
        }
        type_.store(type, std::memory_order_release);
        for (int i = 0; i < count(); ++i) {
            *pins_[i] = i == type;
        }
        return 0;
    }
    kinematics::Status forward(const double *joints, kinematics::Pose &pose) const noexcept {
        for (int i = 0; i < count(); ++i) {
            const TypePart *part = types_[static_cast<std::size_t>(i)];
            if (part != &now()) {
                part->watch(joints);
            }
        }
        return now().forward(joints, pose);
    }
    kinematics::Status inverse(const kinematics::Pose &pose, double *joints) const noexcept {
        return now().inverse(pose, joints);
    }
    int side(const kinematics::Pose &pose) const noexcept { return now().side(pose); }
    /// True when any thread may call the functions at any time.
    bool isPure() const noexcept { return user_.isPure(); }

  private:
    static constexpr int MAX_TYPES = 3;

    static bool isSame(const char *a, const char *b) noexcept {
        while (*a != '\0' && *a == *b) {
            ++a;
            ++b;
        }
        return *a == *b;
    }
    int count() const noexcept { return types_[MAX_TYPES - 1] == nullptr ? MAX_TYPES - 1 : MAX_TYPES; }
    /// Pairs with switch_to: the planner thread always sees a complete type.
    const TypePart &now() const noexcept {
        return *types_[static_cast<std::size_t>(type_.load(std::memory_order_acquire))];
    }

    kinematics::Trivial letters_;
    PartOf<kinematics::Trivial> identity_{letters_};
    UserType user_{letters_};
    std::array<const TypePart *, MAX_TYPES> types_;
    std::atomic<int> type_{0};
    hal_bit_t **pins_ = nullptr;
};

}  // namespace mw::components

/// A module with a model, identity and a user type. `live` is an object with forward and inverse;
/// `declare_model(comp_id, letters)` creates its pins, takes its letters, and returns 0 or a negated errno.
#define MW_SWITCHABLE_MODULE(live, name, default_letters, declare_model)                                     \
    static mw::components::PartOf model_part(live);                                                          \
    static mw::components::Switchable switchable(model_part);                                                \
    MW_SWITCHED_MODULE(name, default_letters, declare_model)

/// The arguments, the functions and the load code of a module with an object `switchable`.
#define MW_SWITCHED_MODULE(name, default_letters, declare_model)                                             \
    static char *coordinates;                                                                                \
    RTAPI_MP_STRING(coordinates, "axis letters in the order of the joints");                                 \
    static char *sparm;                                                                                      \
    RTAPI_MP_STRING(sparm, "identityfirst: type 0 is identity");                                             \
    MW_KINEMATICS_FUNCTIONS(switchable);                                                                     \
    MW_KINEMATICS_PURE_IF(switchable.isPure());                                                              \
    extern "C" int kinematicsSwitchable(void) {                                                              \
        return 1;                                                                                            \
    }                                                                                                        \
    extern "C" int kinematicsSwitch(int type) {                                                              \
        return switchable.switch_to(type);                                                                   \
    }                                                                                                        \
    EXPORT_SYMBOL(kinematicsSwitchable);                                                                     \
    EXPORT_SYMBOL(kinematicsSwitch);                                                                         \
    static int declare_switchable(int comp_id) {                                                             \
        const char *letters =                                                                                \
            coordinates != nullptr && coordinates[0] != '\0' ? coordinates : default_letters;                \
        const int status = switchable.declare(comp_id, name, letters, sparm);                                \
        return status < 0 ? status : declare_model(comp_id, letters);                                        \
    }                                                                                                        \
    MW_KINEMATICS_MAIN(name, declare_switchable)
