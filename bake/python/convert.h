// SPDX-License-Identifier: Apache-2.0
// Converts results, texts and lists to Python values.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "formats/base/result.h"

namespace relief {

namespace py = pybind11;

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;

/// relief.Error and its subclasses, by ErrorCode; created by the module.
inline std::map<ErrorCode, py::object>* g_errors = nullptr;

/// Converts a message, which may contain bytes of a file name, to a Python string with surrogate escapes.
inline py::object textOf(const std::string& message) {
    return py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(message.data(), static_cast<py::ssize_t>(message.size()), "surrogateescape"));
}

inline py::list textsOf(const std::vector<std::string>& messages) {
    py::list texts;
    for (const std::string& message : messages) {
        texts.append(textOf(message));
    }
    return texts;
}

[[noreturn]] inline void raise(const Error& error) {
    const auto found = g_errors->find(error.code);
    const py::object& type = found == g_errors->end() ? g_errors->at(ErrorCode::kFailure) : found->second;
    PyErr_SetObject(type.ptr(), textOf(error.message).ptr());
    throw py::error_already_set();
}

/// Returns the value, or throws the Python exception. Requires the GIL.
template <class T>
T need(Result<T> result) {
    if (!result) {
        raise(result.error());
    }
    return std::move(*result);
}

inline void need(const Result<void>& done) {
    if (!done) {
        raise(done.error());
    }
}

/// Collects one member of all items into an array of shape (n,), or (n, 3) for vectors and (n, 4) for quaternions.
template <class T, class Class, class Item>
auto column(const std::vector<Item>& items, T Class::*member) {
    const auto count = static_cast<py::ssize_t>(items.size());
    if constexpr (std::is_arithmetic_v<T>) {
        py::array_t<T> array(count);
        std::ranges::transform(items, array.mutable_data(), [&](const Item& item) { return item.*member; });
        return array;
    } else {
        static_assert(std::is_same_v<std::remove_cvref_t<decltype((items[0].*member)[0])>, float>);
        constexpr std::size_t kParts = sizeof(T) / sizeof(float);
        Floats array({count, static_cast<py::ssize_t>(kParts)});
        for (std::size_t i = 0; i < items.size(); ++i) {
            std::copy_n(&(items[i].*member)[0], kParts, array.mutable_data() + kParts * i);
        }
        return array;
    }
}

/// Adds the class Simulation.
void addSimulation(py::module_& m);

}  // namespace relief
