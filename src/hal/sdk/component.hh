// SPDX-License-Identifier: GPL-2.0-or-later
// The C++ way to write a realtime component: a struct of pins and parameters, one function that declares
// them, and functions that run in the thread. Works with -fno-exceptions -fno-rtti; adds nothing at run time
// over the C API.
//
//     struct And2 {
//         mw::sdk::In<bool> in0, in1;
//         mw::sdk::Out<bool> out;
//
//         void declare(mw::sdk::Declare &d)
//         {
//             d.pin(in0, "in0");                    // and2.0.in0
//             d.pin(in1, "in1");
//             d.pin(out, "out");
//             d.function<&And2::update>(this);      // and2.0
//         }
//         void update() noexcept { out = in0 && in1; }
//     };
//     MW_COMPONENT(And2, "and2", 16)
//
// That component takes count=N (and2.0, and2.1, ...; at most 16) or names=a,b (a, b); one instance by
// default.
#pragma once

// Plain file names, because these files are beside this one also when installed.
#include "declare.hh"
#include "module.hh"
#include "numbers.hh"
#include "pins.hh"
