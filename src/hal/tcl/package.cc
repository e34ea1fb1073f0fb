// SPDX-License-Identifier: GPL-2.0-or-later
// Exports of the shared part: the interpreter for our own programs, and the Tcl package Hal for any tclsh.
#include <memory>

#include "hal/core/host.hh"
#include "hal/host/host_client.hh"
#include "hal/tcl/interpreter.hh"

#define MW_EXPORT __attribute__((visibility("default")))

namespace {

namespace script = mw::hal::script;

/// The session of a tclsh that has loaded the package: attached to the user's instance.
struct PackageSession {
    std::unique_ptr<mw::hal::HostClient> host;
    script::StandardOutput output;
    std::unique_ptr<script::SystemProgramHost> programs;
    std::unique_ptr<script::Session> session;
};

void delete_session(ClientData data, Tcl_Interp *) {
    delete static_cast<PackageSession *>(data);
}

}  // namespace

extern "C" {

MW_EXPORT mw::hal::script::ScriptRunner *mw_new_script_runner(mw::hal::script::Session *session,
                                                              std::size_t layout) {
    return layout != script::session_layout() ? nullptr : new mw::hal::tcl::Interpreter(*session);
}

MW_EXPORT int Hal_Init(Tcl_Interp *interpreter) {
    if (Tcl_PkgRequire(interpreter, "Tcl", "8.6", 0) == nullptr) {
        return TCL_ERROR;
    }
    const std::string instance = mw::hal::default_instance();
    auto host = mw::hal::isHostAlive(instance)
                    ? mw::hal::HostClient::connect(instance)
                    : mw::hal::HostClient::start(instance, mw::hal::MessagesTo::FILE);
    if (!host) {
        const std::string text = host.error().str();
        Tcl_SetObjResult(interpreter, Tcl_NewStringObj(text.c_str(), -1));
        return TCL_ERROR;
    }
    auto own = std::make_unique<PackageSession>();
    own->host = std::move(*host);
    own->programs = std::make_unique<script::SystemProgramHost>(own->host->hal());
    script::SessionOptions options;
    options.library = script::default_library();
    own->session = std::make_unique<script::Session>(*own->host, *own->programs, own->output, options);
    mw::hal::tcl::add_commands(interpreter, *own->session);
    // tclsh ends itself.
    Tcl_CallWhenDeleted(interpreter, delete_session, own.release());
    return Tcl_PkgProvide(interpreter, "Hal", "1.0");
}

}  // extern "C"
