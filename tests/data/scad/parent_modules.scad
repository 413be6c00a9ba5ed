module a() { echo($parent_modules, parent_module(0)); children(); }
module b() { a() children(); }
a() echo(parent_module(0), $parent_modules);
b() echo(parent_module(0), parent_module(1), $parent_modules);
echo(parent_module(0));
