for (v = [[undef], [true], [1], ["s"], [[1]], [[1:2]], [function(x) x], [0 / 0], [[]], [""]])
  echo(is_undef(v[0]), is_bool(v[0]), is_num(v[0]), is_string(v[0]), is_list(v[0]), is_function(v[0]));
echo(is_num(1 / 0), is_list([]), is_undef([][0]));
