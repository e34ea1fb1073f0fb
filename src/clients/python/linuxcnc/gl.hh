// SPDX-License-Identifier: GPL-2.0-or-later
// The OpenGL 1.1 functions with which screens draw, from the system's library. It is loaded at first use, so
// a machine without a screen does not need it.
#pragma once

namespace mw::python {

struct Gl {
    static constexpr unsigned LINES = 1, LINE_STRIP = 3;
    static constexpr unsigned UNSIGNED_BYTE = 0x1401, FLOAT = 0x1406;
    static constexpr unsigned VERTEX_ARRAY = 0x8074, COLOR_ARRAY = 0x8076;

    void (*begin)(unsigned mode);
    void (*end)();
    void (*vertex)(const double *xyz);
    void (*color)(const float *rgba);
    void (*load_name)(unsigned name);
    void (*enable_client_state)(unsigned array);
    void (*disable_client_state)(unsigned array);
    void (*vertex_pointer)(int size, unsigned type, int stride, const void *first);
    void (*color_pointer)(int size, unsigned type, int stride, const void *first);
    void (*draw_arrays)(unsigned mode, int first, int count);

    /// Throws linuxcnc.error if the library is missing.
    static const Gl &library();
};

}  // namespace mw::python
