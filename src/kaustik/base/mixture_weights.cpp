#include "kaustik/base/mixture_weights.h"

#include <fmt/format.h>

#include <algorithm>

#include "kaustik/base/number_list.h"

namespace kaustik {
namespace {

constexpr double largest_weight = 1e6;

NumberList numbers_of(const Value& weights) {
  if (const auto* text = std::get_if<std::string>(&weights)) return parse_number_list(*text);
  if (const auto* number = std::get_if<double>(&weights)) return {{*number}, ""};
  if (const auto* integer = std::get_if<int64_t>(&weights)) return {{double(*integer)}, ""};
  return {};
}

}  // namespace

MixtureWeights mixture_weights(const Value& weights, size_t count, std::string_view parts) {
  const std::string remedy =
      fmt::format("give numbers from 0 to 1 with commas between, one for each of the {}", parts);
  auto [numbers, wrong_word] = numbers_of(weights);
  if (!wrong_word.empty())
    return {{}, fmt::format("'weights' holds '{}', which is no number", wrong_word), remedy};
  for (const double number : numbers)
    if (!(number >= 0 && number <= largest_weight))
      return {{},
              fmt::format("'weights' holds {}, which is {}", number,
                          number > 0 ? "above a million" : "below 0"),
              remedy};
  if (numbers.size() != count)
    return {{},
            fmt::format("'weights' has {} number{}, for {} {}", numbers.size(),
                        numbers.size() == 1 ? "" : "s", count, parts),
            "give one for each, in their order"};
  if (std::all_of(numbers.begin(), numbers.end(), [](double number) { return number == 0; }))
    return {{}, "'weights' are all 0", "give one of them a larger value"};
  return {std::move(numbers), "", ""};
}

}  // namespace kaustik
