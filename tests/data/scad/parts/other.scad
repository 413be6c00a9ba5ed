use <values.scad>
function from_include(x) = ["other", x];
function own() = "theirs";
