// SPDX-License-Identifier: GPL-2.0-or-later
// The few functions of OpenGL 1.1 with which screens' pictures are drawn, from the system's library. It is
// loaded when first drawn with: a machine without a picture needs none.
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

    /// Throws linuxcnc.error when there is none.
    static const Gl &library();
};

}  // namespace mw::python
