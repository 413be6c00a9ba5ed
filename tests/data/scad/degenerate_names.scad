true1 = 1; undef_ = 2; echo1 = 3; eachx = 4; module_ = 5;
echo(true1, undef_, echo1, eachx, module_);
module function_(if_) echo(if_);
function_(if_ = 6);
function for_(let_) = let_ + 1;
echo(for_(let_ = 1));
