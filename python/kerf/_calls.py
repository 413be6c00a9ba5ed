"""Calls of the compiled module as of Python functions: their signatures, and messages that name the argument.

A compiled function refuses arguments with a list of its forms. `install` replaces each by a function that
says instead which argument is wrong, what was expected and what was given.
"""

import ast
import functools
import inspect
import re

_FORM = re.compile(r"^(?:\d+\. )?(\w*)\((.*)\)(?: -> (.+))?$")
_REFUSED = re.compile(r"incompatible (?:function|constructor) arguments")
_NO_CAST = re.compile(
    r"^Unable to cast Python instance(?: of type <class '(?:\w+\.)*(\w+)'>)?.*?(?:'([^']+)')?$", re.S
)
_TYPES = {"float": "a number", "int": "a whole number", "bool": "True or False", "str": "a str"}
_CPP_TYPES = {"double": "a number", "int": "a whole number", "bool": "True or False"}
_SPECIAL = ("__init__", "__getitem__", "__setitem__", "__contains__", "__call__")
_LONGEST = 60  # letters of a value in a message


def _split(text):
    """The parts between commas that are in no bracket and no quotes."""
    parts, depth, quote, start = [], 0, "", 0
    for i, c in enumerate(text):
        if quote:
            quote = "" if c == quote else quote
        elif c in "'\"":
            quote = c
        elif c in "([{<":
            depth += 1
        elif c in ")]}" or c == ">" and text[i - 1] != "-":
            depth -= 1
        elif c == "," and depth == 0:
            parts.append(text[start:i].strip())
            start = i + 1
    return [*parts, text[start:].strip()] if text.strip() else []


_DEFAULTS = {"None": None, "True": True, "False": False, "''": "", "[]": [], "()": ()}


def _default(text):
    if text in _DEFAULTS:  # compiling each would take a third of the time of `import kerf`
        return _DEFAULTS[text]
    try:
        return float(text) if "." in text else int(text)
    except ValueError:
        pass
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError):
        return ...


# How later versions of pybind11 name the numbers that they convert, and what may be None.
_SPELLINGS = (
    (re.compile(r"(?:typing\.)?SupportsFloat(?: \| (?:typing\.)?SupportsIndex)?"), "float"),
    (re.compile(r"(?:typing\.)?SupportsInt(?: \| (?:typing\.)?SupportsIndex)?"), "int"),
    (re.compile(r"^([^|]+) \| None$"), r"Optional[\1]"),
)


def _annotation(kind):
    kind = kind.replace("kerf._kerf.", "").strip()
    for spelling, own in _SPELLINGS:
        kind = spelling.sub(own, kind)
    return inspect.Parameter.empty if kind in ("", "object") else kind


def _parameter(text, after_star):
    """A parameter of a form: `name: type = default`, `*args`, `**kwargs`."""
    kinds = inspect.Parameter
    if text.startswith("**"):
        return kinds(text[2:].split(":")[0], kinds.VAR_KEYWORD)
    if text.startswith("*"):
        return kinds(text[1:].split(":")[0], kinds.VAR_POSITIONAL)
    head, equals, default = text.partition(" = ")
    name, _, kind = head.partition(": ")
    name = {"arg0": "value"}.get(name, name)
    return kinds(
        name,
        kinds.KEYWORD_ONLY if after_star else kinds.POSITIONAL_OR_KEYWORD,
        default=_default(default) if equals else kinds.empty,
        annotation=_annotation(kind),
    )


def _form(parameters, result):
    found, after_star = [], False
    for text in _split(parameters):
        if text == "*":
            after_star = True
        elif text != "/":
            found.append(_parameter(text, after_star))
            after_star = after_star or text.startswith("*")
    kind = _annotation(result or "")
    return inspect.Signature(found, return_annotation=None if kind == "None" else kind)


def forms_of(function):
    """The signatures of a compiled function, one for each of its forms."""
    name = getattr(function, "__name__", "")
    found = []
    for line in (function.__doc__ or "").splitlines():
        match = _FORM.match(line)
        if match and match.group(1) == name and not match.group(2).startswith("*args, **kwargs"):
            try:
                found.append(_form(match.group(2), match.group(3)))
            except ValueError:  # a sentence that looks like a signature
                continue
    return found


def text_of(function):
    """The docstring without the lines of the signatures; the texts of several forms one after another."""
    name = getattr(function, "__name__", "")
    lines = [
        line
        for line in (function.__doc__ or "").splitlines()
        if not ((m := _FORM.match(line)) and m.group(1) == name) and line != "Overloaded function."
    ]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)).strip() or None


def _accepts(kind, value, module):
    """Whether a value is of a type as signatures name it; True for types that are not known here."""
    if kind is inspect.Parameter.empty or kind == "object":
        return True
    outer, _, inner = kind.partition("[")
    parts = _split(inner[:-1])
    outer = outer.rpartition(".")[2]
    if outer == "Optional":
        return value is None or _accepts(parts[0], value, module)
    if outer == "float":
        return hasattr(value, "__float__") or hasattr(value, "__index__")
    if outer == "int":
        return hasattr(value, "__index__")
    if outer == "bool":
        return isinstance(value, bool) or type(value).__name__ in ("bool_", "bool")
    if outer == "str":
        return isinstance(value, (str, bytes))
    if outer.lower() == "dict":
        return isinstance(value, dict) and all(
            not parts or _accepts(parts[0], k, module) and _accepts(parts[1], v, module)
            for k, v in value.items()
        )
    if outer.lower() in ("list", "tuple", "sequence"):
        if isinstance(value, (str, bytes)) or not hasattr(value, "__len__"):
            return False
        if outer.lower() == "tuple" and parts and "..." not in parts:
            return len(value) == len(parts) and all(
                map(functools.partial(_accepts, module=module), parts, value)
            )
        return not parts or all(_accepts(parts[0], v, module) for v in value)
    if outer in ("slice", "bytes"):
        return type(value).__name__ == outer
    cls = getattr(module, outer, None)
    if not isinstance(cls, type):
        return True
    return isinstance(value, cls) or outer == "Toolpath" and isinstance(value, module.Program)


def _in_words(kind):
    """A type in words."""
    outer, _, inner = kind.partition("[")
    parts = [_in_words(part) for part in _split(inner[:-1]) if part != "..."]
    outer = outer.rpartition(".")[2]
    if outer == "Optional":
        return parts[0] + " or None"
    if outer.lower() in ("list", "sequence"):
        return (
            "a list of " + re.sub(r"^an? ", "", parts[0]) + "s"
            if parts and "(" not in parts[0]
            else (f"a list of {parts[0]}" if parts else "a list")
        )
    if outer.lower() == "tuple" and parts:
        return "(" + ", ".join(parts) + ")"
    if outer.lower() == "dict" and parts:
        return f"a dict of {parts[0]} to {parts[1]}".replace(" a ", " ").replace("dict of a ", "dict of ")
    return _TYPES.get(outer) or ("an " if outer[:1] in "aeiouAEIO" else "a ") + outer


def _shown(value):
    """A value in a message: itself if it is short, else its type."""
    if value is None or isinstance(value, (bool, int, float, str)):
        text = repr(value)
        return text if len(text) <= _LONGEST else text[:_LONGEST] + "..."
    return type(value).__name__


def _wrong_part(name, kind, value, module):
    """(name, expected type, value) of the first wrong element of a list; else of the whole."""
    outer, _, inner = kind.partition("[")
    if (
        outer.rpartition(".")[2].lower() in ("list", "sequence")
        and isinstance(value, (list, tuple))
        and inner
    ):
        for i, element in enumerate(value):
            if not _accepts(inner[:-1], element, module):
                return _wrong_part(f"{name}[{i}]", inner[:-1], element, module)
    return name, kind, value


def _wrong_argument(form, args, kwargs, module):
    """(how far the arguments are right, name, expected type, value) of a form; or a text instead of the
    name."""
    try:
        bound = form.bind(*args, **kwargs)
    except TypeError as error:
        return (-1, str(error), None, None)
    for at, (name, value) in enumerate(bound.arguments.items()):
        kind = form.parameters[name].annotation
        if form.parameters[name].kind.name.startswith("VAR"):
            continue
        if not _accepts(kind, value, module):
            return (at, *_wrong_part(name, kind, value, module))
    return (-2, "", None, None)


def _call_of(form, name):
    """A call as in a manual: name(to, feed, *, rotary=None); of private functions the public name alone."""
    if name.startswith("_"):
        return name.lstrip("_") + "()"
    if name.endswith("__getitem__"):
        return name.rpartition(".")[0] + "[index]"
    parameters = [p.replace(annotation=p.empty) for p in form.parameters.values() if p.name != "self"]
    text = str(inspect.Signature(parameters)).replace("=Ellipsis", "=...")
    return name + text


def message(forms, name, args, kwargs, module):
    """What is wrong with the arguments of a call that the compiled function has refused."""
    reasons = [_wrong_argument(form, args, kwargs, module) for form in forms]
    at, wrong, kind, value = max(reasons, key=lambda reason: reason[0])
    expected = " or ".join(dict.fromkeys(_call_of(form, name) for form in forms))
    if kind is None:
        return f"{name.lstrip('_')}(): {wrong or 'wrong types of arguments'}; expected {expected}"
    kinds = [reason[2] for reason in reasons if reason[0] == at and reason[1] == wrong]
    types = " or ".join(dict.fromkeys(map(_in_words, kinds)))
    return f"{wrong} must be {types}, not {_shown(value)}; in {expected}"


def _of_cast(text, name):
    """A value inside of a sequence or dict had a wrong type."""
    given, wanted = _NO_CAST.match(text).groups()
    wanted = _CPP_TYPES.get(wanted) or ("a str" if "string" in (wanted or "") else "another type")
    return f"{name.lstrip('_')}(): an argument contains {given or 'a value'} where {wanted} is expected"


def wrapped(function, name, module, forms=None, class_text=""):
    """A function that calls the compiled one, with a signature, and with messages about its arguments."""
    forms = _named_rest(forms or forms_of(function), class_text or text_of(function))

    # An object whose construction fails is left out of the frame: test runners and debuggers that show the
    # arguments would read what was never made.
    at = 1 if name.partition(".")[0] == name and getattr(function, "__name__", "") == "__init__" else 0

    def call(*args, **kwargs):
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            text = str(error)
            if _REFUSED.search(text):
                text = message(forms, name, args, kwargs, module)
            elif text.startswith("Unable to cast Python instance"):
                text = _of_cast(text, name)
            else:
                args = args[at:]
                raise
        except Exception:
            args = args[at:]
            raise
        args = args[at:]
        raise TypeError(text)

    call.__name__ = getattr(function, "__name__", "") or name.rpartition(".")[2]
    call.__qualname__ = name if "." not in name else name.rpartition(".")[0] + "." + call.__name__
    call.__doc__, call.__module__, call.__wrapped__ = text_of(function), "kerf", function
    call.__signature__ = _longest(forms)
    return call


def _named_rest(forms, text):
    """The forms with the names that the docstring has for further arguments: *paths, **sizes, or names."""
    documented = re.findall(r"^(\*{0,2}\w+(?:, \w+)*) : ", text or "", re.M)
    names = [name for row in documented for name in row.split(", ")]
    return [form.replace(parameters=_further(form.parameters, names)) for form in forms]


def _further(parameters, names):
    rest = {
        inspect.Parameter.VAR_POSITIONAL: [name[1:] for name in names if re.match(r"\*\w", name)],
        inspect.Parameter.VAR_KEYWORD: [name[2:] for name in names if name.startswith("**")],
    }
    found = []
    for parameter in parameters.values():
        if stated := rest.get(parameter.kind):
            found.append(parameter.replace(name=stated[0]))
        elif parameter.kind == parameter.VAR_KEYWORD and set(names) - set(parameters):
            keyword = inspect.Parameter.KEYWORD_ONLY
            further = [name for name in names if name not in parameters]
            found += [inspect.Parameter(name, keyword, default=...) for name in further]
        else:
            found.append(parameter)
    return found


def _longest(forms):
    """The form with the most parameters; those that another form has not can be left out."""
    longest = max(forms, key=lambda form: len(form.parameters))
    parameters = [
        (
            p.replace(default=None)
            if p.default is p.empty
            and p.kind == p.POSITIONAL_OR_KEYWORD
            and any(p.name not in form.parameters for form in forms)
            else p
        )
        for p in longest.parameters.values()
    ]
    return longest.replace(parameters=[p.replace(annotation=_shown_type(p.annotation)) for p in parameters])


def _shown_type(kind):
    return {"float": float, "int": int, "bool": bool, "str": str}.get(kind, kind)


def _refuse_construction(cls):
    def __init__(self, *args, **kwargs):
        raise TypeError(f"a {cls.__name__} is made by Kerf, not by a call; see help(kerf.{cls.__name__})")

    return __init__


def _install_class(cls, module):
    for member, value in list(vars(cls).items()):
        if member.startswith("__") and member not in _SPECIAL:
            continue
        inner = value.__func__ if isinstance(value, staticmethod) else value
        if member == "__init__" and type(value).__name__ == "wrapper_descriptor":
            if not issubclass(cls, Exception):
                cls.__init__ = _refuse_construction(cls)
                cls.__signature__ = inspect.Signature()
        elif isinstance(value, property):
            if value.fset is not None and forms_of(value.fset):
                setter = wrapped(value.fset, member, module, [_setter_form(member, value.fset)])
                setattr(cls, member, property(value.fget, setter, doc=value.__doc__))
        elif forms_of(inner):
            name = cls.__name__ if member == "__init__" else f"{cls.__name__}.{member}"
            class_text = cls.__doc__ if member == "__init__" else ""
            function = wrapped(inner, name, module, class_text=class_text)
            setattr(cls, member, staticmethod(function) if isinstance(value, staticmethod) else function)


def _setter_form(member, setter):
    first, value = list(forms_of(setter)[0].parameters.values())[:2]
    return inspect.Signature([first.replace(name="self"), value.replace(name=member)])


def install(module):
    """Replaces the functions of a compiled module and the methods of its classes."""
    for name, value in list(vars(module).items()):
        if inspect.isclass(value):
            if value.__module__ == module.__name__ and name != "Machine":
                value.__module__ = module.__name__.rpartition(".")[0]
            _install_class(value, module)
            if issubclass(value, Exception):
                value.__signature__ = inspect.Signature(
                    [inspect.Parameter("message", inspect.Parameter.POSITIONAL_ONLY)]
                )
        elif inspect.isbuiltin(value) and forms_of(value):
            setattr(module, name, wrapped(value, name, module))
