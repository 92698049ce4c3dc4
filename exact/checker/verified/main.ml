(* touchstone-check-verified: the checker whose mathematics is proved (Proof.v), with the arguments,
   the output and the exit status of touchstone-check. *)

open Certificate

exception Not_covered of string

let usage =
  "usage: touchstone-check-verified [OPTIONS] FILE|-\n\n\
   Checks the certificates of queries in a file, or on standard input for '-': each is accepted only\n\
   if it proves its claim, by a checker that is itself proved. The format: exact/CERTIFICATES.md; what\n\
   has to be believed: docs/trust.md.\n\n\
   --claim CLAIM     Reject whatever claims anything else: no_collision, collision,\n\
  \                  'time_of_impact [LO HI]', no_inversion, inversion, 'time_of_inversion [LO HI]'\n\
   --separation D    Reject whatever is about another distance (0: contact itself)\n\
   --norm NORM       The norm of --separation: linf (the default) or l2\n\n\
   Exit status: 0 all accepted and the stream complete, 1 one rejected or the stream cut, 2\n\
   unreadable input, unwritable output, wrong usage, or certificates of steps, which are not covered.\n\n\
   Example: zstdcat proofs.cert.zst | touchstone-check-verified -\n"

type options = { claim : string; separation : string }

type report = {
  accepted : int array;  (* by claim: of collisions, then of inversions *)
  mutable rejected : int;
  mutable rejections : (int * string * string) list;  (* the first ones: line, label, reason *)
}

let max_rejections = 100

let note_rejection report r label line reason =
  report.rejected <- report.rejected + 1;
  if report.rejected <= max_rejections then
    let line = if line <> 0 then line else r.number in
    report.rejections <- report.rejections @ [ (line, printable label, reason) ]

let is_demanded demand text = demand = "" || text = demand || starts_with (demand ^ " ") text

let require_demanded options (c : certificate) =
  let line = c.claim_line in
  let claim = text_of_claim c.is_tetrahedron c.claim in
  let separation = text_of_separation (of_coq c.separation.distance_of) c.separation.norm_of in
  if not (is_demanded options.claim claim) then
    reject ~line ("the claim is not the one demanded: " ^ claim);
  if options.separation <> "" && options.separation <> separation then
    reject ~line ("the separation is not the one demanded: " ^ separation)

(* Checks the certificate that begins at the present line, and goes to where the next may begin. *)
let check_one report options r =
  let first = r.number in
  let label = ref "" in
  let is_read = ref false in
  (try
     let c = read_certificate r (fun text -> label := text) in
     is_read := true;
     require_demanded options c;
     require_small_numbers c;
     if not (Elaborate.check c) then begin
       let line, reason = Elaborate.fault c in
       reject ~line reason
     end;
     let claim =
       match c.claim with Checker.No_collision -> 0 | Checker.Collision -> 1 | Checker.Time_of_impact _ -> 2
     in
     let place = if c.is_tetrahedron then 3 + claim else claim in
     report.accepted.(place) <- report.accepted.(place) + 1
   with Rejection (line, reason) -> note_rejection report r !label line reason);
  let may_begin () = first_word r = "query" || first_word r = "certificates" in
  if not !is_read then
    while (not r.at_end) && (r.number = first || not (may_begin ())) do advance r done

let check_end options r certificates =
  let expected = "certificates " ^ string_of_int certificates in
  if r.at_end then reject ("the stream is cut: it has no closing line '" ^ expected ^ "'");
  if certificates = 0 && (options.claim <> "" || options.separation <> "") then
    reject "there is no certificate of what is demanded";
  begin_keyword r "certificates";
  if r.text <> expected then
    reject (Printf.sprintf "expected the closing line '%s', found %s" expected (quoted r.text));
  advance r;
  if not r.at_end then reject "a line after the closing line"

let check options channel =
  let report =
    { accepted = Array.make 6 0; rejected = 0; rejections = [] }
  in
  let r = reader_of channel in
  let header = "touchstone-certificates 2" in
  (try
     advance r;
     if r.text = "touchstone-steps 2" then raise (Not_covered "certificates of steps");
     if r.text = "touchstone-meshes 1" then raise (Not_covered "certificates of meshes");
     if r.text <> header then reject ~line:1 ("the first line is not '" ^ header ^ "'");
     advance r;
     let queries = ref 0 in
     while (not r.at_end) && first_word r <> "certificates" do
       if first_word r = "query" then incr queries;
       check_one report options r
     done;
     check_end options r !queries
   with Rejection (line, reason) -> note_rejection report r "" line reason);
  report

let print report =
  let n = report.accepted in
  Printf.printf "accepted         %d\n  no_collision   %d\n  collision      %d\n  time_of_impact %d\n"
    (Array.fold_left ( + ) 0 n) n.(0) n.(1) n.(2);
  if n.(3) + n.(4) + n.(5) > 0 then
    Printf.printf "  no_inversion      %d\n  inversion         %d\n  time_of_inversion %d\n" n.(3) n.(4) n.(5);
  Printf.printf "rejected         %d\n" report.rejected;
  let print_rejection (line, label, reason) =
    let name = if label = "" then "" else " (" ^ label ^ ")" in
    Printf.printf "  line %d%s: %s\n" line name reason
  in
  List.iter print_rejection report.rejections;
  let hidden = report.rejected - List.length report.rejections in
  if hidden > 0 then Printf.printf "  and %d more\n" hidden

type arguments = Help | Wrong | Check of string list * options

let rec parsed words files claim separation norm =
  match words with
  | [] -> (
      match files with
      | [] | "" :: _ | _ :: _ :: _ :: _ | [ _; ("-" | "") ] -> Wrong
      | _ when separation = "" && norm <> "" -> Wrong
      | _ ->
          let norm = if norm = "" then "linf" else norm in
          let separation = if separation = "" then "" else demanded_separation separation norm in
          Check (files, { claim; separation }))
  | "--help" :: _ -> Help
  | word :: rest when word = "-" || not (starts_with "-" word) ->
      parsed rest (files @ [ word ]) claim separation norm
  | _ :: ([] | "" :: _) -> Wrong
  | "--claim" :: value :: rest -> parsed rest files (demanded_claim value) separation norm
  | "--separation" :: value :: rest -> parsed rest files claim value norm
  | "--norm" :: value :: rest -> parsed rest files claim separation value
  | _ -> Wrong

let fail message = prerr_string ("touchstone-check-verified: " ^ message ^ "\n"); 2

let check_file path options =
  let channel =
    if path = "-" then stdin
    else try open_in_bin path with Sys_error _ -> failwith "the file cannot be opened"
  in
  set_binary_mode_in channel true;
  let report =
    try check options channel with Sys_error _ -> failwith "the stream cannot be read"
  in
  print report;
  if report.rejected = 0 then 0 else 1

let run () =
  match parsed (List.tl (Array.to_list Sys.argv)) [] "" "" "" with
  | Help -> print_string usage; 0
  | Wrong -> prerr_string usage; 2
  | exception Rejection (_, reason) -> fail reason
  | Check ([ path ], options) -> (
      try check_file path options with
      | Failure reason -> fail (path ^ ": " ^ reason)
      | Not_covered what -> fail (path ^ ": not covered: " ^ what))
  | Check (files, _) -> fail (List.hd files ^ ": not covered: certificates of steps, and scenes")

let () =
  let status = run () in
  match flush stdout with
  | () -> exit status
  | exception Sys_error _ ->
      (* Output that cannot be written is not tried again at exit. *)
      prerr_string "touchstone-check-verified: standard output cannot be written\n";
      Unix._exit 2
