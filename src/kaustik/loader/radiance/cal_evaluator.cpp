#include "kaustik/loader/radiance/cal_evaluator.h"

#include <fmt/format.h>

#include <cmath>

#include "kaustik/loader/radiance/cal_functions.h"

namespace kaustik::radiance {

CalEvaluator::CalEvaluator(CalProgram& program)
    : program_(program), if_(program.symbol_of("if")), select_(program.symbol_of("select")) {}

void CalEvaluator::set(std::string_view name, double value) {
  const uint32_t symbol = program_.symbol_of(name);
  if (symbol >= set_.size()) {
    set_.resize(symbol + 1, 0);
    is_set_.resize(symbol + 1, 0);
  }
  set_[symbol] = value;
  is_set_[symbol] = 1;
}

void CalEvaluator::set_function(std::string_view name,
                                std::function<double(std::span<const double>)> function) {
  own_[program_.symbol_of(name)] = std::move(function);
}

double CalEvaluator::value(uint32_t root) {
  ++now_;
  steps_ = depth_ = calls_ = 0;
  cached_.resize(program_.symbols());
  return evaluate(root, nullptr);
}

double CalEvaluator::call(std::string_view name, std::span<const double> arguments) {
  ++now_;
  steps_ = depth_ = calls_ = 0;
  const uint32_t symbol = program_.symbol_of(name);
  cached_.resize(program_.symbols());
  return call_with(symbol, arguments);
}

void CalEvaluator::count_step() {
  if (++steps_ > most_steps) throw CalError("a function takes too many steps");
}

double CalEvaluator::evaluate(uint32_t index, Frame* frame) {
  count_step();
  if (++depth_ > 20 * deepest_call) throw CalError("functions nest too deep");
  const CalNode& node = program_.node(index);
  const auto operand = [&](size_t i) { return evaluate(node.children[i], frame); };
  double result = 0;
  switch (node.op) {
    case CalNode::Op::number:
      result = node.number;
      break;
    case CalNode::Op::name:
      result = name_value(node.symbol, frame);
      break;
    case CalNode::Op::call:
      result = call_symbol(node.symbol, node.children, frame);
      break;
    case CalNode::Op::add:
      result = operand(0) + operand(1);
      break;
    case CalNode::Op::subtract:
      result = operand(0) - operand(1);
      break;
    case CalNode::Op::multiply:
      result = operand(0) * operand(1);
      break;
    case CalNode::Op::divide:
      result = operand(0) / operand(1);
      break;
    case CalNode::Op::power:
      result = std::pow(operand(0), operand(1));
      break;
    case CalNode::Op::negate:
      result = -operand(0);
      break;
  }
  --depth_;
  return result;
}

int CalEvaluator::parameter_of(uint32_t symbol, const Frame* frame) {
  if (!frame) return -1;
  const auto& parameters = frame->function->parameters;
  for (size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i] == symbol) return int(i);
  return -1;
}

double CalEvaluator::parameter_value(int parameter, Frame* frame) {
  const auto i = size_t(parameter);
  if (!frame->is_known[i]) {
    frame->known[i] =
        frame->values.empty() ? evaluate(frame->arguments[i], frame->caller) : frame->values[i];
    frame->is_known[i] = 1;
  }
  return frame->known[i];
}

double CalEvaluator::name_value(uint32_t symbol, Frame* frame) {
  if (const int parameter = parameter_of(symbol, frame); parameter >= 0)
    return parameter_value(parameter, frame);
  if (symbol < is_set_.size() && is_set_[symbol]) return set_[symbol];
  const CalDefinition* variable = program_.definition_of(symbol);
  if (!variable || variable->is_function)
    throw CalError(fmt::format("nothing defines '{}'", program_.name_of(symbol).substr(0, 40)));
  if (cached_[symbol].when == now_) return cached_[symbol].value;
  if (++calls_ > deepest_call) throw CalError("functions call one another without end");
  const double value = evaluate(variable->root, nullptr);
  --calls_;
  cached_[symbol] = {value, now_};
  return value;
}

double CalEvaluator::run(const CalDefinition& function, Frame frame) {
  if (++calls_ > deepest_call) throw CalError("functions call one another without end");
  frame.function = &function;
  frame.known.resize(function.parameters.size());
  frame.is_known.resize(function.parameters.size(), 0);
  const double value = evaluate(function.root, &frame);
  --calls_;
  return value;
}

double CalEvaluator::call_symbol(uint32_t symbol, std::span<const uint32_t> arguments,
                                 Frame* frame) {
  // A parameter may stand for a function.
  if (const int parameter = parameter_of(symbol, frame); parameter >= 0) {
    Frame* holder = frame;
    uint32_t named = symbol;
    for (int at = parameter; at >= 0; at = parameter_of(named, holder)) {
      if (!holder->values.empty()) throw CalError("a number is called as a function");
      const CalNode& given = program_.node(holder->arguments[size_t(at)]);
      if (given.op != CalNode::Op::name) throw CalError("what is no function is called as one");
      named = given.symbol;
      holder = holder->caller;
    }
    // Arguments are computed here, for they belong to this frame.
    std::vector<double> values;
    for (const uint32_t argument : arguments) values.push_back(evaluate(argument, frame));
    return call_with(named, values);
  }
  const CalDefinition* function = program_.definition_of(symbol);
  if (function && function->is_function) {
    if (arguments.size() < function->parameters.size())
      throw CalError(fmt::format("'{}' has too few arguments", program_.name_of(symbol)));
    Frame inner;
    inner.arguments = arguments;
    inner.caller = frame;
    return run(*function, std::move(inner));
  }
  if (symbol == if_) {
    if (arguments.size() < 3) throw CalError("'if' has too few arguments");
    return evaluate(evaluate(arguments[0], frame) > 0 ? arguments[1] : arguments[2], frame);
  }
  if (symbol == select_) {
    const double which = std::floor(evaluate(arguments[0], frame) + 0.5);
    if (which == 0) return double(arguments.size() - 1);
    if (!(which > 0 && which < double(arguments.size())))
      throw CalError("'select' selects what is not there");
    return evaluate(arguments[size_t(which)], frame);
  }
  std::vector<double> values;
  for (const uint32_t argument : arguments) values.push_back(evaluate(argument, frame));
  return call_with(symbol, values);
}

double CalEvaluator::call_with(uint32_t symbol, std::span<const double> values) {
  const CalDefinition* function = program_.definition_of(symbol);
  if (function && function->is_function && function->parameters.size() <= values.size()) {
    Frame frame;
    frame.values = values;
    return run(*function, std::move(frame));
  }
  if (const auto own = own_.find(symbol); own != own_.end()) return own->second(values);
  const std::string& name = program_.name_of(symbol);
  const CalFunction* builtin = find_cal_function(name);
  if (!builtin)
    throw CalError(fmt::format("nothing defines the function '{}'", name.substr(0, 40)));
  if (values.size() < builtin->arguments)
    throw CalError(fmt::format("'{}' has too few arguments", name));
  return builtin->function(values.data());
}

}  // namespace kaustik::radiance
