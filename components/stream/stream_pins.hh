// SPDX-License-Identifier: GPL-2.0-or-later
// The pins of one stream: one for each letter of its configuration. Common to sampler and streamer.
#pragma once

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct StreamPins {
    hal_stream_t stream{};
    int count = 0;
    hal_type_t type[HAL_STREAM_MAX_PINS] = {};
    hal_data_u *slot[HAL_STREAM_MAX_PINS] = {};

    /// Creates the stream and the pins PREFIX.pin.0, PREFIX.pin.1, ... of the types in `config`.
    void declare(Declare &d, hal_pin_dir_t dir, int key, unsigned depth, const char *config) noexcept {
        if (!d.keep(hal_stream_create(&stream, d.comp_id(), key, depth, config))) {
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "%s: no stream with depth=%u cfg=%s; letters are b f s u l k, at most %d",
                            d.prefix(), depth, config, HAL_STREAM_MAX_PINS);
            return;
        }
        count = hal_stream_element_count(&stream);
        for (int i = 0; i < count; ++i) {
            char name[HAL_NAME_LEN + 1];
            rtapi_snprintf(name, sizeof name, "%s.pin.%d", d.prefix(), i);
            type[i] = hal_stream_element_type(&stream, i);
            d.keep(hal_pin_new(name, type[i], dir, reinterpret_cast<void **>(&slot[i]), d.comp_id()));
        }
    }

    /// The pins' values as a record.
    void read(hal_stream_data_u *record) const noexcept {
        for (int i = 0; i < count; ++i) {
            const hal_data_u *pin = slot[i];
            switch (type[i]) {
            case HAL_BIT: record[i].b = pin->b; break;
            case HAL_FLOAT: record[i].f = pin->f; break;
            case HAL_S32: record[i].s = pin->s; break;
            case HAL_U32: record[i].u = pin->u; break;
            case HAL_S64: record[i].l = pin->ls; break;
            default: record[i].k = pin->lu; break;
            }
        }
    }

    /// Sets the pins to a record.
    void write(const hal_stream_data_u *record) noexcept {
        for (int i = 0; i < count; ++i) {
            hal_data_u *pin = slot[i];
            switch (type[i]) {
            case HAL_BIT: pin->b = record[i].b; break;
            case HAL_FLOAT: pin->f = record[i].f; break;
            case HAL_S32: pin->s = record[i].s; break;
            case HAL_U32: pin->u = record[i].u; break;
            case HAL_S64: pin->ls = record[i].l; break;
            default: pin->lu = record[i].k; break;
            }
        }
    }
};

/// Loads one T for each item of cfg=, with prefix MODULE.N. `all` receives them, null-terminated.
template <class T>
int load_streams(const char *module, const int *depth, char *const *cfg, T **all, int max) noexcept {
    const int comp_id = hal_init(module);
    if (comp_id < 0) {
        return comp_id;
    }
    int status = 0;
    int count = 0;
    while (count < max && cfg[count] != nullptr && cfg[count][0] != '\0' && status == 0) {
        Name prefix;
        rtapi_snprintf(prefix.text, sizeof prefix.text, "%s.%d", module, count);
        T *stream = make<T>();
        if (stream == nullptr) {
            status = -ENOMEM;
        } else if (depth[count] < 1) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: cfg=%s needs a depth= of at least 1", prefix.text,
                            cfg[count]);
            status = -EINVAL;
        } else {
            Declare declare(comp_id, prefix.text, count);
            stream->declare(declare, static_cast<unsigned>(depth[count]), cfg[count]);
            status = declare.status();
            all[count] = stream;
            ++count;
        }
    }
    if (count == 0 && status == 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: cfg= and depth= are missing, for example cfg=ffb depth=1000",
                        module);
        status = -EINVAL;
    }
    return finish(comp_id, status);
}

}  // namespace mw::components
