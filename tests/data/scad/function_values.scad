// function values: what OpenSCAD 2021.01 prints.
echo(log(2,8), log(10,100), log(1,1), log("a",2), log(2,"a"));
echo(cross([1/0,2],[1,2]), cross([1,2],[true,"a"]), cross([0/0,1],[1,2]), cross([1,2,true],[1,2,3]), cross([1,2,1/0],[1,2,3]),cross([1,undef],[2,3]));
echo(version_num(), version_num([2019,5,1]), version_num([2019,5]), version_num([2019]), version_num("a"), version_num([2019,5,1,2]), version_num(["a",5,1]), version_num(undef), version_num([2019,5,"x"]), version_num([2019.5,5,1]));
echo(search(undef,"a"), search(true,"a"), search([1:2],"a"), search(1,"a"), search(1,1), search("a",1), search("a",undef), search("ab",1), search(undef,[1]), search(undef,undef), search(true,1));
echo(search("a",1,0), search("a",1,"x"), search("ab",true,undef), search("a",undef,0), search("abc",[1:2]), search("", 1), search("a",1,1,1), search("a",1,2));
echo(search(1,"a",0), search(1,"abc",0), search(1,"",0),search(2,"abc",2), search(1,"a",1,1), search(1,"a",5));
echo(search([1,2],"a"), search([1,"a"],"abca"), search(["a"],"abca",0), search(["ab"],"abab"), search([["a"]],"a"), search(["a","b"], 1), search([1,2],undef,0));
echo(search("a", "abca", "x"), search("a","abca",undef), search("a","abca",-1), search("a","abca",1/0), search("a","abca",0.5), search("a","abca",1.5), search("a","abca",0/0), search("a","abca",[0]));
