#pragma once
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace kaustik {

/// Objects that computations need for a while, such as lists, and that keep their memory for the
/// next one. Who computes often owns it and hands it on; then nothing is allocated any more once
/// each object has been as large as it gets. For one thread at a time.
class Scratch {
  /// An object that nobody has, in a list of all of its type.
  struct Kept {
    virtual ~Kept() = default;
    std::unique_ptr<Kept> next;
  };
  template <typename T>
  struct Object final : Kept {
    T value;
  };

 public:
  /// An object that is its borrower's alone. It goes back at the end of this, which the Scratch
  /// must outlive.
  template <typename T>
  class Borrowed {
   public:
    Borrowed(Borrowed&& other) noexcept = default;
    Borrowed& operator=(Borrowed&&) = delete;
    ~Borrowed() {
      if (object_) from_->give_back(shelf_, std::move(object_));
    }
    T& operator*() const { return object_->value; }
    T* operator->() const { return &object_->value; }

   private:
    friend class Scratch;
    Borrowed(Scratch& from, size_t shelf, std::unique_ptr<Object<T>> object)
        : from_(&from), shelf_(shelf), object_(std::move(object)) {}

    Scratch* from_;
    size_t shelf_;
    std::unique_ptr<Object<T>> object_;
  };
  template <typename T>
  using List = Borrowed<std::vector<T>>;

  Scratch() = default;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  /// One that nobody has; as its last borrower left it.
  template <typename T>
  Borrowed<T> borrow() {
    const size_t shelf = shelf_of(&key<T>);
    std::unique_ptr<Kept>& first = shelves_[shelf].first;
    if (!first) return {*this, shelf, std::make_unique<Object<T>>()};
    std::unique_ptr<Object<T>> object(static_cast<Object<T>*>(first.release()));
    first = std::move(object->next);
    return {*this, shelf, std::move(object)};
  }
  /// An empty list.
  template <typename T>
  List<T> list() {
    List<T> result = borrow<std::vector<T>>();
    result->clear();
    return result;
  }

 private:
  /// All objects of a type that nobody has.
  struct Shelf {
    const void* key;
    std::unique_ptr<Kept> first;
  };
  /// Its address stands for the type.
  template <typename T>
  static constexpr char key = 0;

  size_t shelf_of(const void* wanted) {
    // They are few.
    size_t shelf = 0;
    while (shelf < shelves_.size() && shelves_[shelf].key != wanted) ++shelf;
    if (shelf == shelves_.size()) shelves_.push_back({wanted, nullptr});
    return shelf;
  }
  void give_back(size_t shelf, std::unique_ptr<Kept> object) {
    object->next = std::move(shelves_[shelf].first);
    shelves_[shelf].first = std::move(object);
  }

  std::vector<Shelf> shelves_;
};

}  // namespace kaustik
