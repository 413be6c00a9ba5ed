// The compact form a program runs in: instructions on numbered slots, 16 bytes each.
//
// A function's slots are its parameters, its other variables, then temporaries; the program itself uses the
// slots of the global variables the same way. Operands of 0 and more are slots, negative ones are constants
// (~operand).
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "front/gcmc/text/ast.h"
#include "front/gcmc/value/value.h"

namespace kerf::gcmc {

/// X(name) for every instruction: `x` is the slot written, a, b, c are operands unless said otherwise.
// clang-format off
#define KERF_GCMC_OPS(X)                                                                              \
  X(move)  /* x <- a */                                                                               \
  X(get_global)  /* x <- global slot a */                                                             \
  X(get_dynamic)  /* x <- slot a if that exists, else global slot b */                                \
  X(dereference)  /* x <- what slot a refers to */                                                    \
  X(refer)  /* x <- reference to slot a */                                                            \
  X(refer_dynamic)  /* x <- reference to slot a if that exists, else global b if that does, else a */ \
  X(need_target)  /* error unless what slot a refers to exists */                                     \
  X(store)  /* what slot x refers to <- a, refused where that is a constant */                        \
  X(add)  /* x <- a op b; so the next eleven */                                                       \
  X(sub)                                                                                              \
  X(mul)                                                                                              \
  X(div)                                                                                              \
  X(mod)                                                                                              \
  X(add_or)                                                                                           \
  X(sub_or)                                                                                           \
  X(bit_and)                                                                                          \
  X(bit_or)                                                                                           \
  X(bit_xor)                                                                                          \
  X(shift_left)                                                                                       \
  X(shift_right)                                                                                      \
  X(add_integer)  /* x <- slot a op b, b being an integer itself; so the next four */                 \
  X(sub_integer)                                                                                      \
  X(mul_integer)                                                                                      \
  X(div_integer)  /* b is neither 0 nor -1; so the next */                                            \
  X(mod_integer)                                                                                      \
  X(append)  /* x <- a + {b} */                                                                       \
  X(equal)  /* x <- a op b; so the next five */                                                       \
  X(not_equal)                                                                                        \
  X(less)                                                                                             \
  X(greater)                                                                                          \
  X(less_equal)                                                                                       \
  X(greater_equal)                                                                                    \
  X(logic_not)  /* x <- op a */                                                                       \
  X(bit_not)  /* x <- op a */                                                                         \
  X(apply)  /* what slot x refers to op= a; b is the op */                                            \
  X(step)  /* ++ or -- on slot a; x <- value before or after, as the flags say */                     \
  X(step_target)  /* the same on what slot a refers to */                                             \
  X(step_element)  /* the same on element b (and c of that) of what slot a refers to */               \
  X(index)  /* x <- a[b] */                                                                           \
  X(element)  /* x <- element b (and c of that) of what slot a refers to; must exist */               \
  X(set_element)  /* element a (and b of that) of what slot x refers to <- c; grows */                \
  X(jump)  /* by c */                                                                                 \
  X(jump_if)  /* by c, on the truth of a */                                                           \
  X(jump_unless)                                                                                      \
  X(jump_less)  /* by c, on a op b; so the next five */                                               \
  X(jump_greater)                                                                                     \
  X(jump_less_equal)                                                                                  \
  X(jump_greater_equal)                                                                               \
  X(jump_equal)                                                                                       \
  X(jump_not_equal)                                                                                   \
  X(jump_less_integer)  /* by c, on slot a op b, b being an integer itself; so the next five */       \
  X(jump_greater_integer)                                                                             \
  X(jump_less_equal_integer)                                                                          \
  X(jump_greater_equal_integer)                                                                       \
  X(jump_equal_integer)                                                                               \
  X(jump_not_equal_integer)                                                                           \
  X(vector)  /* x <- vector of b slots from a */                                                      \
  X(vector2)  /* x <- [a, b] */                                                                       \
  X(vector3)  /* x <- [a, b, c] */                                                                    \
  X(list)  /* x <- list of b slots from a */                                                          \
  X(call)  /* x <- function a with c arguments from slot b */                                         \
  X(call_builtin)  /* x <- built-in a with c arguments from slot b */                                 \
  X(define)  /* function a exists from now on */                                                      \
  X(give_back)  /* return a, from a function */                                                       \
  X(end_program)  /* return a, from the program itself */                                             \
  X(give_nothing)  /* return without a value */                                                       \
  X(declare_local)  /* slot x <- a, if it does not exist yet; warns otherwise */                      \
  X(declare_constant)  /* slot x <- a, once; b is the global slot of that name or -1 */               \
  X(warn_global)  /* local outside of a function: name a */                                           \
  X(repeat_begin)  /* x, x+1 <- limit and counter from a */                                           \
  X(repeat_next)  /* next count into slot a; jumps by c while there is one */                         \
  X(foreach_begin)  /* x, x+1 <- source a and position */                                             \
  X(foreach_next)  /* next item into slot a; jumps by c while there is one */                         \
  X(clear)  /* slots a up to b hold nothing */                                                        \
  X(stray_break)  /* error: break outside of a loop (a = 0), or no lvalue (1) */                      \
  X(unknown_function)  /* error: name a */                                                            \
  X(by_reference)  /* error: argument b of function a is no variable */                               \
  X(wrong_count)  /* error: arguments of function a */                                                \
  X(stop)  /* the end of the program */
// clang-format on

enum class Op : std::uint8_t {
#define X(name) name,
  KERF_GCMC_OPS(X)
#undef X
};

/// The form of an operation or comparing jump whose right side is an integer in the instruction.
constexpr Op with_integer(Op op) {
  constexpr int kToOperation = static_cast<int>(Op::add_integer) - static_cast<int>(Op::add);
  constexpr int kToJump = static_cast<int>(Op::jump_less_integer) - static_cast<int>(Op::jump_less);
  return static_cast<Op>(static_cast<int>(op) + (op <= Op::mod ? kToOperation : kToJump));
}
static_assert(with_integer(Op::mod) == Op::mod_integer);
static_assert(with_integer(Op::jump_not_equal) == Op::jump_not_equal_integer);

/// Bits of Instruction::flags.
enum : std::uint8_t {
  kTakeA = 1,  // operand a is a temporary that nothing else reads: take its value
  kTakeB = 2,  // the same for b
  kTakeC = 4,
  kNegated = 8,      // a comparing jump: jump where the comparison does not hold
  kBackward = 16,    // a jump back: counts as a loop step
  kMinus = 32,       // a step is --
  kPrefix = 64,      // a step's value is the one after
  kValueUsed = 128,  // a call's value is needed
};

struct Instruction {
  Op op;
  std::uint8_t flags = 0;
  std::uint16_t x = 0;
  std::int32_t a = 0, b = 0, c = 0;
};
static_assert(sizeof(Instruction) == 16);

constexpr std::int32_t kNoOperand = INT32_MIN;

struct FunctionCode {
  NameId name = kNoName;
  std::size_t entry = 0;
  std::int32_t parameters = 0;
  std::int32_t variables = 0;  // slots with names, parameters among them
  std::int32_t frame = 0;      // all slots
  bool constants = false;      // it declares some
  bool walks = false;          // it has a foreach, whose hidden slot holds what is walked
  std::vector<NameId> slot_names;
  std::vector<bool> by_reference;
};

struct Program {
  std::vector<Instruction> instructions;
  std::vector<Place> places;  // of each instruction
  std::vector<Value> constants;
  std::vector<FunctionCode> functions;  // in the order of Tree::functions
  FunctionCode program;                 // its variables are the global ones
  std::unordered_map<NameId, std::int32_t> global_slots;
};

}  // namespace kerf::gcmc
