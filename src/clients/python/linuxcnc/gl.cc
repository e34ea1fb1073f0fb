// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/linuxcnc/gl.hh"

#include <dlfcn.h>

#include <string>

#include "clients/python/linuxcnc/module.hh"

namespace mw::python {
namespace {

constexpr const char *LIBRARY = "libGL.so.1";

template <typename Function>
void find(void *library, const char *name, Function *&function) {
    function = reinterpret_cast<Function *>(::dlsym(library, name));
    if (function == nullptr) {
        throw_error(std::string(LIBRARY) + " has no function " + name);
    }
}

Gl load() {
    void *const library = ::dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        throw_error(std::string("nothing can be drawn without OpenGL (Debian's package libgl1): ") +
                    ::dlerror());
    }
    Gl gl{};
    find(library, "glBegin", gl.begin);
    find(library, "glEnd", gl.end);
    find(library, "glVertex3dv", gl.vertex);
    find(library, "glColor4fv", gl.color);
    find(library, "glLoadName", gl.load_name);
    find(library, "glEnableClientState", gl.enable_client_state);
    find(library, "glDisableClientState", gl.disable_client_state);
    find(library, "glVertexPointer", gl.vertex_pointer);
    find(library, "glColorPointer", gl.color_pointer);
    find(library, "glDrawArrays", gl.draw_arrays);
    return gl;
}

}  // namespace

const Gl &Gl::library() {
    static const Gl gl = load();
    return gl;
}

}  // namespace mw::python
