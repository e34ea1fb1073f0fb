// SPDX-License-Identifier: GPL-2.0-or-later
// hal.h: pins and parameters.
#include <cstdarg>
#include <cstring>

#include "hal/capi/status.hh"
#include "runtime/format.hh"

namespace mw::hal::capi {
namespace {

Type type_of(hal_type_t type) {
    return static_cast<Type>(type);
}

/// A name formatted as by printf. A name that is too long is reported and left empty.
struct FormattedName {
    char text[NAME_LENGTH + 1];
    bool good;

    FormattedName(const char *format, std::va_list args) {
        const int length = runtime::format_text(text, sizeof text, format, args);
        good = length > 0 && length <= static_cast<int>(NAME_LENGTH);
        if (!good) {
            complain(EINVAL, fmt::format("HAL name '{}...' has {} characters, 1 to {} are allowed", text,
                                         length, NAME_LENGTH));
        }
    }
};

int new_pin(const char *name, hal_type_t type, hal_pin_dir_t dir, void **slot, int comp_id) {
    return with_hal([&](Instance &hal) {
        return hal.pins().create(name, type_of(type), static_cast<Dir>(dir), slot, comp_id);
    });
}

int new_param(const char *name, hal_type_t type, hal_param_dir_t dir, const volatile void *address,
              int comp_id) {
    return with_hal([&](Instance &hal) {
        return hal.params().create(name, type_of(type), static_cast<Dir>(dir), const_cast<void *>(address),
                                   comp_id);
    });
}

int set_param(const char *name, const Value &value) {
    return with_hal([&](Instance &hal) {
        const auto param = hal.params().get(name);
        return param ? status_of(hal.values().set(name, value))
                     : status_of(Result<>(std::unexpected(param.error())));
    });
}

/// For the newer interface of LinuxCNC: a pin's slot, or a parameter with its own memory.
template <class Ref>
int new_reference(int comp_id, hal_pdir_t dir, Ref *reference, const Value &start, const char *name) {
    auto **ref = reinterpret_cast<void **>(reference);
    return with_hal([&](Instance &hal) {
        if (hal_pdir_is_pin(dir) == 0) {
            void *memory = hal.memory().allocate(sizeof(std::uint64_t));
            if (memory == nullptr) {
                return complain(ENOMEM, "no HAL memory left");
            }
            *ref = memory;
            store_value(memory, start);
            return new_param(name, static_cast<hal_type_t>(start.type), dir, memory, comp_id);
        }
        const int status = new_pin(name, static_cast<hal_type_t>(start.type), dir, ref, comp_id);
        if (status == 0) {
            store_value(*ref, start);
        }
        return status;
    });
}

template <class T>
void **slot_of(T **data_ptr_addr) {
    return reinterpret_cast<void **>(const_cast<std::remove_volatile_t<T> **>(data_ptr_addr));
}

}  // namespace
}  // namespace mw::hal::capi

using namespace mw;
using namespace mw::hal;
using namespace mw::hal::capi;

extern "C" {

int hal_pin_new(const char *name, hal_type_t type, hal_pin_dir_t dir, void **data_ptr_addr, int comp_id) {
    return new_pin(name, type, dir, data_ptr_addr, comp_id);
}

int hal_param_new(const char *name, hal_type_t type, hal_param_dir_t dir, void *data_addr, int comp_id) {
    return new_param(name, type, dir, data_addr, comp_id);
}

int hal_param_set(const char *name, hal_type_t type, void *value_addr) {
    Value value{type_of(type), 0};
    const std::size_t size = type == HAL_BIT ? 1 : type == HAL_S32 || type == HAL_U32 ? 4 : 8;
    std::memcpy(&value.bits, value_addr, size);
    return set_param(name, value);
}

int hal_param_new_fake(int compid, hal_refs_u *refs) {
    return with_hal([&](Instance &hal) {
        if (refs == nullptr || !hal.components().find(compid)) {
            return complain(EINVAL, fmt::format("there is no component {}", compid));
        }
        refs->p = hal.memory().allocate(sizeof(std::uint64_t));
        return refs->p == nullptr ? complain(ENOMEM, "no HAL memory left") : 0;
    });
}

// ---- the symbols that hal.h has once for each type; the lists of types follow the macros

/// The object `name`, from the format and the arguments behind it.
#define MW_FORMAT_NAME(name, format)                                                                         \
    std::va_list args;                                                                                       \
    va_start(args, format);                                                                                  \
    const FormattedName name(format, args);                                                                  \
    va_end(args)

/// hal_pin_TYPE_new and hal_pin_TYPE_newf.
#define MW_EXPORT_PIN(TYPE, CONSTANT)                                                                        \
    int hal_pin_##TYPE##_new(const char *name, hal_pin_dir_t dir, hal_##TYPE##_t **data, int comp_id) {      \
        return new_pin(name, CONSTANT, dir, slot_of(data), comp_id);                                         \
    }                                                                                                        \
    int hal_pin_##TYPE##_newf(hal_pin_dir_t dir, hal_##TYPE##_t **data, int comp_id, const char *fmt, ...) { \
        MW_FORMAT_NAME(name, fmt);                                                                           \
        return name.good ? new_pin(name.text, CONSTANT, dir, slot_of(data), comp_id) : -EINVAL;              \
    }

/// hal_param_TYPE_new, hal_param_TYPE_newf and hal_param_TYPE_set, which takes an ARGUMENT and stores it as
/// STORED.
#define MW_EXPORT_PARAM(TYPE, CONSTANT, ARGUMENT, STORED)                                                    \
    int hal_param_##TYPE##_new(const char *name, hal_param_dir_t dir, hal_##TYPE##_t *data, int comp_id) {   \
        return new_param(name, CONSTANT, dir, data, comp_id);                                                \
    }                                                                                                        \
    int hal_param_##TYPE##_newf(hal_param_dir_t dir, hal_##TYPE##_t *data, int comp_id, const char *fmt,     \
                                ...) {                                                                       \
        MW_FORMAT_NAME(name, fmt);                                                                           \
        return name.good ? new_param(name.text, CONSTANT, dir, data, comp_id) : -EINVAL;                     \
    }                                                                                                        \
    int hal_param_##TYPE##_set(const char *name, ARGUMENT value) {                                           \
        return set_param(name, Value::of_##TYPE(static_cast<STORED>(value)));                                \
    }

/// hal_pin_new_TYPE and hal_param_new_TYPE of the newer interface: REF refers to the value, which starts as
/// OF(def).
#define MW_EXPORT_REFERENCE(TYPE, REF, START, OF)                                                            \
    int hal_pin_new_##TYPE(int compid, hal_pdir_t dir, REF *ref, START def, const char *fmt, ...) {          \
        MW_FORMAT_NAME(name, fmt);                                                                           \
        return name.good && hal_pdir_is_pin(dir) != 0 ? new_reference(compid, dir, ref, OF(def), name.text)  \
                                                      : -EINVAL;                                             \
    }                                                                                                        \
    int hal_param_new_##TYPE(int compid, hal_pdir_t dir, REF *ref, START def, const char *fmt, ...) {        \
        MW_FORMAT_NAME(name, fmt);                                                                           \
        return name.good && hal_pdir_is_param(dir) != 0                                                      \
                   ? new_reference(compid, dir, ref, OF(def), name.text)                                     \
                   : -EINVAL;                                                                                \
    }

MW_EXPORT_PIN(bit, HAL_BIT)
MW_EXPORT_PIN(float, HAL_FLOAT)
MW_EXPORT_PIN(u32, HAL_U32)
MW_EXPORT_PIN(s32, HAL_S32)
MW_EXPORT_PIN(u64, HAL_U64)
MW_EXPORT_PIN(s64, HAL_S64)
MW_EXPORT_PIN(port, HAL_PORT)

MW_EXPORT_PARAM(bit, HAL_BIT, int, bool)
MW_EXPORT_PARAM(float, HAL_FLOAT, double, double)
MW_EXPORT_PARAM(u32, HAL_U32, unsigned long, rtapi_u32)
MW_EXPORT_PARAM(s32, HAL_S32, signed long, rtapi_s32)
MW_EXPORT_PARAM(u64, HAL_U64, unsigned long, rtapi_u64)
MW_EXPORT_PARAM(s64, HAL_S64, signed long, rtapi_s64)

MW_EXPORT_REFERENCE(bool, hal_bool_t, rtapi_bool, Value::of_bit)
MW_EXPORT_REFERENCE(real, hal_real_t, rtapi_real, Value::of_float)
MW_EXPORT_REFERENCE(sint, hal_sint_t, rtapi_sint, Value::of_s64)
MW_EXPORT_REFERENCE(uint, hal_uint_t, rtapi_uint, Value::of_u64)
MW_EXPORT_REFERENCE(si32, hal_sint_t, rtapi_s32, Value::of_s32)
MW_EXPORT_REFERENCE(ui32, hal_uint_t, rtapi_u32, Value::of_u32)

int hal_pin_new_port(int compid, hal_pin_dir_t dir, hal_sint_t *ref, const char *fmt, ...) {
    MW_FORMAT_NAME(name, fmt);
    return name.good && hal_pdir_is_pin(dir) != 0
               ? new_pin(name.text, HAL_PORT, dir, reinterpret_cast<void **>(ref), compid)
               : -EINVAL;
}

}  // extern "C"
