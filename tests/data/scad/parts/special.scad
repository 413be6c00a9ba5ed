$k = 100;
function read_k() = $k;
module show_k() { echo($k); }
