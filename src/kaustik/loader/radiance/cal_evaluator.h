#pragma once
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "kaustik/loader/radiance/cal_program.h"

namespace kaustik::radiance {

/// Computes values of expressions. Arguments of functions are computed when they are asked for, so
/// that functions may call themselves within `if`. Not for several threads at once.
class CalEvaluator {
 public:
  /// Steps that one value may take, and calls that may wait for one another.
  static constexpr int most_steps = 4'000, deepest_call = 60;

  /// `program` must outlive this, and may grow no more.
  explicit CalEvaluator(CalProgram& program);

  /// A variable that the surroundings set: Px, Dz, A1. Comes before definitions of that name.
  void set(std::string_view name, double value);
  /// A function that the surroundings give, of numbers. Definitions come before it.
  void set_function(std::string_view name, std::function<double(std::span<const double>)> function);
  /// Throws CalError where a name is unknown, or the steps are spent. May be no finite number.
  double value(uint32_t root);
  /// The same of a function, built in or defined.
  double call(std::string_view name, std::span<const double> arguments);

 private:
  /// A call of a function that is defined.
  struct Frame {
    const CalDefinition* function = nullptr;
    std::span<const uint32_t> arguments;  ///< nodes, of the caller
    std::span<const double> values;       ///< in their stead where there are no nodes
    Frame* caller = nullptr;
    std::vector<double> known;
    std::vector<char> is_known;
  };
  struct Cached {
    double value = 0;
    uint64_t when = 0;
  };

  double evaluate(uint32_t index, Frame* frame);
  double name_value(uint32_t symbol, Frame* frame);
  double call_symbol(uint32_t symbol, std::span<const uint32_t> arguments, Frame* frame);
  /// Of numbers.
  double call_with(uint32_t symbol, std::span<const double> values);
  double run(const CalDefinition& function, Frame frame);
  /// Of the parameters of the frame's function; −1: none of them.
  static int parameter_of(uint32_t symbol, const Frame* frame);
  double parameter_value(int parameter, Frame* frame);
  void count_step();

  CalProgram& program_;
  std::vector<double> set_;
  std::vector<char> is_set_;
  std::vector<Cached> cached_;  ///< of variables, by symbol
  std::map<uint32_t, std::function<double(std::span<const double>)>> own_;
  uint32_t if_, select_;
  uint64_t now_ = 0;
  int steps_ = 0, depth_ = 0, calls_ = 0;
};

}  // namespace kaustik::radiance
