// Buffers of numbers between Python and descriptions.
#include <cmath>
#include <cstring>
#include <vector>

#include "bind.h"

namespace kaustik::python {
namespace {

/// What struct calls the type, without its byte order.
const char* format_of(ElementType type) {
  switch (type) {
    case ElementType::uint8:
      return "B";
    case ElementType::uint16:
      return "H";
    case ElementType::uint32:
      return "I";
    case ElementType::int32:
      return "i";
    case ElementType::int64:
      return "q";
    case ElementType::float32:
      return "f";
    case ElementType::float64:
      break;
  }
  return "d";
}

/// Of a buffer's format; ValueError for those that scenes do not hold.
ElementType element_type(const std::string& format, size_t size) {
  std::string code = format;
  if (!code.empty() && (code[0] == '<' || code[0] == '=' || code[0] == '@')) code.erase(0, 1);
  if (code == "f" && size == 4) return ElementType::float32;
  if (code == "d" && size == 8) return ElementType::float64;
  if (code == "B" || code == "c") return ElementType::uint8;
  if (code == "H" && size == 2) return ElementType::uint16;
  if ((code == "I" || code == "L") && size == 4) return ElementType::uint32;
  if ((code == "i" || code == "l") && size == 4) return ElementType::int32;
  if ((code == "l" || code == "q") && size == 8) return ElementType::int64;
  throw py::value_error("elements of format '" + format +
                        "' are none of uint8, uint16, uint32, int32, int64, float32, float64");
}

/// Rows and columns without gaps, whatever the strides are.
std::vector<std::byte> gathered(const py::buffer_info& info) {
  const auto item = size_t(info.itemsize);
  std::vector<std::byte> bytes(size_t(info.size) * item);
  std::vector<py::ssize_t> index(size_t(info.ndim), 0);
  for (size_t i = 0; i < size_t(info.size); ++i) {
    const auto* source = static_cast<const char*>(info.ptr);
    for (size_t d = 0; d < index.size(); ++d) source += index[d] * info.strides[d];
    std::memcpy(bytes.data() + i * item, source, item);
    for (size_t d = index.size(); d-- > 0;) {
      if (++index[d] < info.shape[d]) break;
      index[d] = 0;
    }
  }
  return bytes;
}

Buffer copied(const py::buffer& source) {
  const py::buffer_info info = source.request();
  const ElementType type = element_type(info.format, size_t(info.itemsize));
  const auto owner = std::make_shared<const std::vector<std::byte>>(gathered(info));
  return {Array::borrow(type, {info.shape.begin(), info.shape.end()}, *owner, owner)};
}

/// Of the bytes of a buffer, as pickle keeps them.
Buffer from_bytes(const std::string& type, const std::vector<size_t>& extents,
                  const py::bytes& bytes) {
  for (const ElementType candidate :
       {ElementType::uint8, ElementType::uint16, ElementType::uint32, ElementType::int32,
        ElementType::int64, ElementType::float32, ElementType::float64})
    if (element_name(candidate) == type) {
      const std::string_view view = bytes;
      const auto* first = reinterpret_cast<const std::byte*>(view.data());
      const auto owner = std::make_shared<const std::vector<std::byte>>(first, first + view.size());
      return {Array::borrow(candidate, extents, *owner, owner)};
    }
  throw py::value_error("no element type '" + type + "'");
}

py::buffer_info shown(const Buffer& buffer) {
  const Array& array = *buffer.array;
  const auto item = py::ssize_t(element_size(array.type()));
  std::vector<py::ssize_t> shape(array.extents().begin(), array.extents().end());
  std::vector<py::ssize_t> strides(shape.size());
  py::ssize_t step = item;
  for (size_t d = shape.size(); d-- > 0;) {
    strides[d] = step;
    step *= shape[d];
  }
  return {const_cast<std::byte*>(array.bytes().data()),
          item,
          format_of(array.type()),
          py::ssize_t(shape.size()),
          std::move(shape),
          std::move(strides),
          true};
}

py::dict array_interface(const Buffer& buffer) {
  const Array& array = *buffer.array;
  const bool is_float =
      array.type() == ElementType::float32 || array.type() == ElementType::float64;
  const bool is_signed = array.type() == ElementType::int32 || array.type() == ElementType::int64;
  const size_t size = element_size(array.type());
  py::dict result;
  result["shape"] = py::tuple(py::cast(array.extents()));
  result["typestr"] = std::string(size == 1 ? "|" : "<") +
                      (is_float    ? "f"
                       : is_signed ? "i"
                                   : "u") +
                      std::to_string(size);
  result["data"] = py::make_tuple(reinterpret_cast<uintptr_t>(array.bytes().data()), true);
  result["version"] = 3;
  return result;
}

}  // namespace

void bind_arrays(py::module_& module) {
  py::class_<Buffer>(module, "Buffer", py::buffer_protocol())
      .def(py::init(&copied))
      .def_static("from_bytes", &from_bytes)
      .def_buffer(&shown)
      .def_property_readonly("__array_interface__", &array_interface)
      .def_property_readonly(
          "shape", [](const Buffer& b) { return py::tuple(py::cast(b.array->extents())); })
      .def_property_readonly(
          "dtype", [](const Buffer& b) { return std::string(element_name(b.array->type())); })
      .def("tobytes",
           [](const Buffer& b) {
             return py::bytes(reinterpret_cast<const char*>(b.array->bytes().data()),
                              b.array->bytes().size());
           })
      .def_property_readonly("digest", [](const Buffer& b) { return b.array->digest(); })
      // The first index of a number that is no finite one; -1: none.
      .def("find_not_finite",
           [](const Buffer& b) {
             return b.array->visit([](auto values) -> int64_t {
               for (size_t i = 0; i < values.size(); ++i)
                 if (!std::isfinite(double(values[i]))) return int64_t(i);
               return -1;
             });
           })
      // The first index of a number that is below the first or above the last one; -1: none.
      .def("find_outside",
           [](const Buffer& b, double first, double last) {
             return b.array->visit([&](auto values) -> int64_t {
               for (size_t i = 0; i < values.size(); ++i)
                 if (!(double(values[i]) >= first && double(values[i]) <= last)) return int64_t(i);
               return -1;
             });
           })
      .def("at", [](const Buffer& b, size_t index) {
        return b.array->visit([&](auto values) { return double(values[index]); });
      });
}

}  // namespace kaustik::python
