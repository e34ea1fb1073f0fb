// SPDX-License-Identifier: GPL-2.0-or-later
// A userspace component with its pins and parameters, for Python.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "clients/python/hal/instance.hh"

namespace mw::python {

/// A pin or parameter of a component of this process. Using it after the component has ended throws
/// hal.error.
struct Item {
    HalHandle hal;
    std::string name;  ///< without the prefix
    hal::Type type = hal::Type::BIT;
    hal::Dir dir = hal::Dir::IN;
    bool isPin = true;
    bool isEnded = false;
    void **slot = nullptr;  ///< pin: location of the address of the value in HAL
    void *place = nullptr;  ///< parameter: address of the value

    pybind11::object get() const;
    void set(pybind11::handle value);
    /// Current address of the value.
    volatile void *address() const;
};

class Component {
  public:
    Component(const std::string &name, const std::string &prefix);
    ~Component();
    Component(const Component &) = delete;
    Component &operator=(const Component &) = delete;

    std::shared_ptr<Item> new_item(const std::string &name, int type, int dir, bool isPin);
    /// AttributeError if there is none.
    std::shared_ptr<Item> item(const std::string &name) const;
    std::shared_ptr<Item> item(const std::string &name, bool isPin) const;
    void set_ready(bool isReady);
    void exit();
    int id() const;
    HalHandle hal() const { return hal_; }

    std::string name;
    std::string prefix;
    std::map<std::string, std::shared_ptr<Item>> items;

  private:
    HalHandle hal_;
    int id_ = 0;
};

}  // namespace mw::python
