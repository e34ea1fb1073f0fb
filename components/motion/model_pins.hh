// SPDX-License-Identifier: GPL-2.0-or-later
// Pins from the table of a model's parameters, and modules made of a model and its pins.
#pragma once

#include <cerrno>
#include <new>

#include "components/motion/kinematics_module.hh"
#include "kinematics/parameters.hh"

namespace mw::components {

/// The model with the values of its pins at each call.
template <class Model>
class PinnedModel {
  public:
    /// Creates the pins PREFIX.NAME with the start values from the table. Returns 0 or a negated errno.
    /// [while loading]
    int declare(int comp_id, const char *prefix) noexcept {
        void *memory = hal_malloc(static_cast<long>(sizeof(Cells)));
        if (memory == nullptr) {
            return -ENOMEM;
        }
        cells_ = new (memory) Cells{};
        for (std::size_t i = 0; i < Model::COUNT; ++i) {
            const int status = declare_one(Model::PARAMETERS[i], cells_->of[i], comp_id, prefix);
            if (status < 0) {
                return status;
            }
        }
        return 0;
    }
    Model model() const noexcept {
        Model out = base_;
        for (std::size_t i = 0; i < Model::COUNT; ++i) {
            out.set(i, value_of(Model::PARAMETERS[i].kind, cells_->of[i].slot));
        }
        return out;
    }
    /// The part of the model that is not on pins: its letters.
    Model &base() noexcept { return base_; }
    kinematics::Status forward(const double *joints, kinematics::Pose &pose) const noexcept {
        return model().forward(joints, pose);
    }
    kinematics::Status inverse(const kinematics::Pose &pose, double *joints) const noexcept {
        return model().inverse(pose, joints);
    }
    int side(const kinematics::Pose &pose) const noexcept { return model().side(pose); }
    kinematics::LinearJoints linear() const noexcept { return model().linear(); }

  private:
    struct Cell {
        void *slot = nullptr;  // the C API keeps this pointing at the value
        double param = 0;
    };
    struct Cells {
        std::array<Cell, Model::COUNT> of;
    };

    static int declare_one(const kinematics::Parameter &row, Cell &cell, int comp_id,
                           const char *prefix) noexcept {
        char name[HAL_NAME_LEN + 1];
        if (rtapi_snprintf(name, sizeof name, "%s.%s", prefix, row.name) > HAL_NAME_LEN) {
            return -EINVAL;
        }
        int status = 0;
        switch (row.kind) {
        case kinematics::PinKind::FLOAT:
            status = hal_pin_new(name, HAL_FLOAT, HAL_IN, &cell.slot, comp_id);
            break;
        case kinematics::PinKind::FLOAT_IO:
            status = hal_pin_new(name, HAL_FLOAT, HAL_IO, &cell.slot, comp_id);
            break;
        case kinematics::PinKind::FLOAT_PARAM:
            cell.slot = &cell.param;
            status = hal_param_new(name, HAL_FLOAT, HAL_RW, &cell.param, comp_id);
            break;
        case kinematics::PinKind::S32:
            status = hal_pin_new(name, HAL_S32, HAL_IN, &cell.slot, comp_id);
            break;
        case kinematics::PinKind::U32:
            status = hal_pin_new(name, HAL_U32, HAL_IN, &cell.slot, comp_id);
            break;
        case kinematics::PinKind::U32_IO:
            status = hal_pin_new(name, HAL_U32, HAL_IO, &cell.slot, comp_id);
            break;
        }
        if (status >= 0) {
            start(row, cell.slot);
        }
        return status;
    }
    static void start(const kinematics::Parameter &row, void *slot) noexcept {
        switch (row.kind) {
        case kinematics::PinKind::FLOAT:
        case kinematics::PinKind::FLOAT_IO:
        case kinematics::PinKind::FLOAT_PARAM: *static_cast<volatile double *>(slot) = row.start; break;
        case kinematics::PinKind::S32:
            *static_cast<volatile rtapi_s32 *>(slot) = static_cast<rtapi_s32>(row.start);
            break;
        case kinematics::PinKind::U32:
        case kinematics::PinKind::U32_IO:
            *static_cast<volatile rtapi_u32 *>(slot) = static_cast<rtapi_u32>(row.start);
            break;
        }
    }
    static double value_of(kinematics::PinKind kind, const void *slot) noexcept {
        switch (kind) {
        case kinematics::PinKind::FLOAT:
        case kinematics::PinKind::FLOAT_IO:
        case kinematics::PinKind::FLOAT_PARAM: break;
        case kinematics::PinKind::S32: return *static_cast<const volatile rtapi_s32 *>(slot);
        case kinematics::PinKind::U32:
        case kinematics::PinKind::U32_IO: return *static_cast<const volatile rtapi_u32 *>(slot);
        }
        return *static_cast<const volatile double *>(slot);
    }

    Model base_;
    Cells *cells_ = nullptr;
};

}  // namespace mw::components

/// A module with one type: the model and its pins, NAME.PARAMETER.
#define MW_MODEL_MODULE(Model, name)                                                                         \
    static mw::components::PinnedModel<Model> pinned;                                                        \
    MW_KINEMATICS(pinned);                                                                                   \
    MW_KINEMATICS_PURE;                                                                                      \
    static int declare_pins(int comp_id) {                                                                   \
        return pinned.declare(comp_id, name);                                                                \
    }                                                                                                        \
    MW_KINEMATICS_MAIN(name, declare_pins)
