// The code of a program: instructions of 16 bytes on numbered slots.
//
// The slots of a function are its parameters, its other variables, then temporaries; the program itself is
// such a function, with the global variables. Operands >= 0 are slots, operands < 0 are constants (~operand).
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "front/gcmc/text/ast.h"
#include "front/gcmc/value/value.h"

namespace kerf::gcmc {

/// X(name) for every instruction: `x` is the slot written; a, b, c are operands unless stated otherwise.
// clang-format off
#define KERF_GCMC_OPS(X)                                                                              \
  X(move)  /* x <- a */                                                                               \
  X(get_global)  /* x <- global slot a */                                                             \
  X(get_dynamic)  /* x <- slot a if that exists, else global slot b */                                \
  X(dereference)  /* x <- target of slot a */                                                         \
  X(refer)  /* x <- reference to slot a */                                                            \
  X(refer_dynamic)  /* x <- reference to slot a if that exists, else global b if that does, else a */ \
  X(need_target)  /* error unless the target of slot a exists */                                      \
  X(store)  /* target of slot x <- a; error if that is a constant */                                  \
  X(add)  /* x <- a op b; likewise the next eleven */                                                 \
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
  X(add_integer)  /* x <- slot a op b, where b is an integer; likewise the next four */               \
  X(sub_integer)                                                                                      \
  X(mul_integer)                                                                                      \
  X(div_integer)  /* b is neither 0 nor -1; likewise the next */                                      \
  X(mod_integer)                                                                                      \
  X(append)  /* x <- a + {b} */                                                                       \
  X(equal)  /* x <- a op b; likewise the next five */                                                 \
  X(not_equal)                                                                                        \
  X(less)                                                                                             \
  X(greater)                                                                                          \
  X(less_equal)                                                                                       \
  X(greater_equal)                                                                                    \
  X(logic_not)  /* x <- op a */                                                                       \
  X(bit_not)  /* x <- op a */                                                                         \
  X(apply)  /* target of slot x op= a; b is the op */                                                 \
  X(step)  /* ++ or -- on slot a; x <- value before or after, by the flags */                         \
  X(step_target)  /* the same on the target of slot a */                                              \
  X(step_element)  /* the same on element b (and c of that) of the target of slot a */                \
  X(index)  /* x <- a[b] */                                                                           \
  X(element)  /* x <- element b (and c of that) of the target of slot a; must exist */                \
  X(set_element)  /* element a (and b of that) of the target of slot x <- c; grows */                 \
  X(jump)  /* by c */                                                                                 \
  X(jump_if)  /* by c, on the truth of a */                                                           \
  X(jump_unless)                                                                                      \
  X(jump_less)  /* by c, on a op b; likewise the next five */                                         \
  X(jump_greater)                                                                                     \
  X(jump_less_equal)                                                                                  \
  X(jump_greater_equal)                                                                               \
  X(jump_equal)                                                                                       \
  X(jump_not_equal)                                                                                   \
  X(jump_less_integer)  /* by c, on slot a op b, where b is an integer; likewise the next five */     \
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
  X(define)  /* defines function a */                                                                 \
  X(return_value)  /* return a, from a function */                                                       \
  X(end_program)  /* return a, from the program itself */                                             \
  X(return_nothing)  /* return without a value */                                                       \
  X(declare_local)  /* slot x <- a, if it does not exist yet; warns otherwise */                      \
  X(declare_constant)  /* slot x <- a, once; b is the global slot of that name or -1 */               \
  X(warn_global)  /* local outside of a function: name a */                                           \
  X(repeat_start)  /* x, x+1 <- limit and counter from a */                                           \
  X(repeat_next)  /* next count into slot a; jumps by c while there is one */                         \
  X(foreach_start)  /* x, x+1 <- source a and position */                                             \
  X(foreach_next)  /* next item into slot a; jumps by c while there is one */                         \
  X(clear)  /* slots a to b - 1 become absent */                                                      \
  X(stray_break)  /* error: break outside of a loop (a = 0), or not an lvalue (1) */                  \
  X(unknown_function)  /* error: name a */                                                            \
  X(by_reference)  /* error: argument b of function a is not a variable */                            \
  X(wrong_count)  /* error: arguments of function a */                                                \
  X(stop)  /* the end of the program */
// clang-format on

enum class Op : std::uint8_t {
#define X(name) name,
  KERF_GCMC_OPS(X)
#undef X
};

/// The form of an operation or comparing jump with an immediate integer as its right operand.
constexpr Op with_integer(Op op) {
  constexpr int kToOperation = static_cast<int>(Op::add_integer) - static_cast<int>(Op::add);
  constexpr int kToJump = static_cast<int>(Op::jump_less_integer) - static_cast<int>(Op::jump_less);
  return static_cast<Op>(static_cast<int>(op) + (op <= Op::mod ? kToOperation : kToJump));
}
static_assert(with_integer(Op::mod) == Op::mod_integer);
static_assert(with_integer(Op::jump_not_equal) == Op::jump_not_equal_integer);

/// Bits of Instruction::flags.
enum : std::uint8_t {
  kTakeA = 1,  // operand a is a temporary that is not read again: move its value
  kTakeB = 2,  // the same for b
  kTakeC = 4,
  kNegated = 8,      // a comparing jump: jump if the comparison is false
  kBackward = 16,    // a backward jump: counts as a loop step
  kMinus = 32,       // a step is --
  kPrefix = 64,      // a step's value is the one after
  kValueUsed = 128,  // the value of a call is used
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
  bool constants = false;      // it declares constants
  bool iterates = false;       // it has a foreach, whose hidden slot holds the source
  std::vector<NameId> slot_names;
  std::vector<bool> by_reference;
};

struct Program {
  std::vector<Instruction> instructions;
  std::vector<SourceLocation> locations;  // of each instruction
  std::vector<Value> constants;
  std::vector<FunctionCode> functions;  // in the order of Tree::functions
  FunctionCode program;                 // its variables are the global ones
  std::unordered_map<NameId, std::int32_t> global_slots;
};

}  // namespace kerf::gcmc
